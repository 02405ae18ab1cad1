// The compiled half of the Python package: cyber_radar/_engine.pyi declares it, and the Python half checks every
// argument before it comes here.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "commit/commit.h"
#include "import/mesh_import.h"
#include "python/arrays.h"
#include "python/batch.h"
#include "python/chains.h"
#include "python/page.h"
#include "python/scene_methods.h"
#include "python/signals.h"
#include "radar/displacement.h"
#include "view/page.h"
#include "workloads/answer_fields.h"
#include "workloads/query_fields.h"

namespace radar::python {

namespace {

// ------------------------------------------------------------------------------------------------------------- casts

/// An argument with the leading dimensions of the batch, and `count` adjacent numbers after them.
template <class T>
PerQuery perQuery(const py::array& array, const std::vector<size_t>& shape, size_t count, const char* name) {
  const auto leading = py::ssize_t(shape.size());
  bool fits = py::isinstance<py::array_t<T>>(array) && array.ndim() >= leading;
  const bool empty = array.size() == 0;  // strides then mean nothing
  PerQuery result;
  for (py::ssize_t d = 0; fits && d < leading; ++d) {
    fits = static_cast<size_t>(array.shape(d)) == shape[size_t(d)];
    result.strides.push_back(array.strides(d));
  }
  size_t adjacent = 1;
  for (py::ssize_t d = array.ndim(); fits && d-- > leading;) {
    fits = empty || array.shape(d) <= 1 || static_cast<size_t>(array.strides(d)) == adjacent * sizeof(T);
    adjacent *= static_cast<size_t>(array.shape(d));
  }
  if (!fits || adjacent != count) throw py::value_error(std::string(name) + ": expected another array");
  result.data = static_cast<const char*>(array.data());
  return result;
}

/// A field's value for all casts, as cast_option() gives it.
void readField(const tools::QueryField& field, const py::object& value, tools::QuerySpec& to) {
  double number = std::nan("");
  bool fits = true;
  if (field.kind() == 'b') {
    number = py::bool_(value);
  } else if (py::isinstance<py::float_>(value)) {
    number = value.cast<double>();
    fits = std::isfinite(number);
  } else if (field.word && value.equal(py::str(field.word))) {
    number = HUGE_VAL;
  } else {
    fits = value.is_none();
  }
  if (fits && setValue(to, field, number)) return;
  throw py::value_error(std::string(field.name) + ": expected " + expectedFor(field) + ", got " +
                        std::string(py::repr(value)));
}

tools::AnswerMode modeFrom(const py::dict& options) {
  const auto mode = options["mode"].cast<std::string>();
  if (mode == "sampled") return tools::AnswerMode::sampled;
  return mode == "reference" ? tools::AnswerMode::reference : tools::AnswerMode::contact;
}

tools::QuerySpec optionsFrom(const py::dict& options) {
  tools::QuerySpec query;
  for (const tools::QueryField& field : tools::queryFields()) {
    if (field.cast) readField(field, options[field.name], query);
  }
  query.resolution = options["resolution"].cast<uint32_t>();
  if (query.hits > 1 && query.anyHit) throw py::value_error("hits: expected 1 with any_hit");
  const tools::QueryField* const exact = exactOnly(query);
  if (exact && modeFrom(options) == tools::AnswerMode::sampled) {
    throw py::value_error("mode: expected \"contact\" or \"reference\" with " + std::string(exact->name) +
                          ", got \"sampled\"");
  }
  return query;
}

/// What _engine.pyi says of cast().
py::tuple listsFor(const Query& options, const std::vector<size_t>& shape, const BatchLists& found) {
  py::object hits = py::none(), overlapping = py::none(), closest = py::none(), exits = py::none();
  const auto recordsOf = [&](const std::string& records) {
    return py::array(py::dtype::from_args(typeOf(tools::castsLayout(false))), shape, records.data());
  };
  if (options.closest) {
    const std::vector<py::ssize_t> own(shape.begin(), shape.end());
    closest = py::make_tuple(recordsOf(found.closest), arrayOf(found.distanceLo, own), arrayOf(found.distanceHi, own));
  }
  if (options.exit) exits = recordsOf(found.exits);
  const auto whole = [](const std::vector<int64_t>& values) { return arrayOf(values, {py::ssize_t(values.size())}); };
  if (options.hits > 1) {
    const py::array records(py::dtype::from_args(typeOf(tools::castsLayout(false))), {found.hitOffsets.back()},
                            found.hits.data());
    hits = py::make_tuple(records, whole(found.hitOffsets));
  }
  if (options.skipOverlapping) {
    overlapping = py::make_tuple(whole(found.overlapping), whole(found.overlappingOffsets));
  }
  py::dict reasons;
  for (const auto& [reason, which] : found.reasons) {
    reasons[py::str(reason)] = arrayOf(which, {py::ssize_t(which.size())});
  }
  return py::make_tuple(hits, overlapping, closest, exits, reasons);
}

py::tuple castArrays(CastingScene& scene, const std::vector<size_t>& shape, const py::dict& arguments,
                     const py::dict& options, py::array& records, const py::object& afterChunk) {
  BatchInput input{.shape = shape};
  const auto argument = [&](const char* name) { return arguments[name].cast<py::array>(); };
  const py::array meshes = argument("mesh"), poses = argument("poses"), displacements = argument("displacements"),
                  masks = argument("mask"), excluded = argument("exclude_from_each");
  input.meshes = perQuery<uint32_t>(meshes, shape, 1, "mesh");
  input.poses = perQuery<double>(poses, shape, 16, "poses");
  input.displacements = perQuery<double>(displacements, shape, 3, "displacements");
  input.masks = perQuery<uint32_t>(masks, shape, 1, "mask");
  input.excludedCount = static_cast<size_t>(excluded.shape(excluded.ndim() - 1));
  input.excluded = perQuery<int64_t>(excluded, shape, input.excludedCount, "exclude_from_each");
  std::vector<py::array> each;  // keeps the arrays alive
  const auto readEach = [&]<class T>(const char* name, PerQuery& to, T) {
    if (arguments.contains(name)) to = perQuery<T>(each.emplace_back(argument(name)), shape, 1, name);
  };
  readEach("distances", input.distances, 0.0);
  if (arguments.contains("turns: axes")) {
    for (const auto& [name, to, width] : {std::tuple{"turns: axes", &input.axes, size_t{3}},
                                          {"turns: angles", &input.angles, 1},
                                          {"turns: centres", &input.centres, 3}}) {
      *to = perQuery<double>(each.emplace_back(argument(name)), shape, width, name);
    }
  }
  readEach("ignore_leaving", input.leaving, false);
  readEach("slack", input.slacks, 0.0);
  readEach("tolerance", input.tolerances, 0.0);
  readEach("clearance", input.clearances, 0.0);
  readEach("hits", input.hits, uint32_t{});
  input.options = optionsFrom(options);
  input.mode = modeFrom(options);
  recordsOf(records, tools::castsLayout(input.mode == tools::AnswerMode::sampled), input.count());
  auto* const to = static_cast<char*>(records.mutable_data());
  BatchLists found;
  const std::function<void()> heedSignals = signalsHeeded();
  {
    const py::gil_scoped_release release;
    found = cast(scene, input, to, heedSignals, [&](size_t done) {
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!afterChunk.is_none()) afterChunk(done);
    });
  }
  return listsFor(input.options, shape, found);
}

// ------------------------------------------------------------------------------------------------- devices and files

py::list deviceReports() {
  py::list list;
  for (const DeviceReport& report : released(listDevices)) {
    py::dict device;
    device["name"] = report.name;
    device["driver"] = report.driver;
    device["type"] = report.type;
    device["version"] = report.version;
    device["memory"] = report.memory;
    device["doubles"] = report.doubles;
    device["reasons"] = report.reasons;
    device["sampled_reasons"] = report.sampledReasons;
    list.append(device);
  }
  return list;
}

py::tuple readMesh(const std::filesystem::path& file, double scale) {
  std::vector<std::string> warnings;
  const tools::FileMesh mesh = released([&] { return tools::readMesh(file, warnings, scale); });
  return py::make_tuple(meshArrays(mesh.positions, mesh.indices, mesh.base), warnings);
}

py::tuple readAssembly(const std::filesystem::path& file, double scale) {
  std::vector<std::string> warnings;
  const tools::Assembly assembly = released([&] { return tools::readAssembly(file, warnings, scale); });
  py::list meshes, names;
  std::vector<uint32_t> placed;
  std::vector<double> transforms;
  for (const tools::FileMesh& mesh : assembly.meshes) {
    meshes.append(meshArrays(mesh.positions, mesh.indices, mesh.base));
  }
  for (const tools::Assembly::Part& part : assembly.parts) {
    // A file may hold a name in any encoding.
    names.append(py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(part.name.data(), py::ssize_t(part.name.size()), "replace")));
    placed.push_back(part.mesh);
    transforms.insert(transforms.end(), part.fileFromNode.m.begin(), part.fileFromNode.m.end());
    transforms.insert(transforms.end(), {0, 0, 0, 1});
  }
  const auto count = py::ssize_t(placed.size());
  return py::make_tuple(meshes, names, arrayOf(placed, {count}), arrayOf(transforms, {count, 4, 4}), warnings);
}

/// What _engine.pyi says of turn_between().
py::tuple turnsBetween(const Array<double>& starts, const Array<double>& ends, const Array<double>& abouts) {
  const auto count = py::ssize_t(starts.size() / 16);
  requireCount(ends, "end", 16 * size_t(count));
  requireCount(abouts, "about", 3 * size_t(count));
  Array<double> axes({count, py::ssize_t(3)}), angles(count), centres({count, py::ssize_t(3)}),
      motions({count, py::ssize_t(3)});
  py::object wrong = py::none();
  for (py::ssize_t i = 0; i < count && wrong.is_none(); ++i) {
    const double* const about = abouts.data() + 3 * i;
    try {
      const auto [turn, motion] = turnBetween(transformFrom(starts.data() + 16 * i),
                                              transformFrom(ends.data() + 16 * i), {about[0], about[1], about[2]});
      std::ranges::copy(turn.axis, axes.mutable_data(i));
      *angles.mutable_data(i) = turn.angle;
      std::ranges::copy(turn.centre, centres.mutable_data(i));
      std::ranges::copy(motion, motions.mutable_data(i));
    } catch (const Error& error) {
      wrong = py::make_tuple(i, error.what());
    }
  }
  return py::make_tuple(axes, angles, centres, motions, wrong);
}

void registerErrors(py::module_& module) {
  static const py::handle error =
      PyErr_NewExceptionWithDoc("cyber_radar.Error",
                                "A set-up failed, such as opening a device. `reasons` has a line for each device if "
                                "none is usable.",
                                PyExc_RuntimeError, nullptr);
  module.attr("Error") = error;
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(std::move(thrown));
    } catch (const Error& what) {
      std::string text = what.what();
      for (const std::string& reason : what.reasons) text += "\n  " + reason;
      const py::object instance = error(text);
      instance.attr("reasons") = what.reasons;
      PyErr_SetObject(error.ptr(), instance.ptr());
    } catch (const tools::InputError& what) {
      PyErr_SetString(PyExc_ValueError, what.what());
    }
  });
}

}  // namespace

}  // namespace radar::python

PYBIND11_MODULE(_engine, module) {
  using namespace radar::python;
  namespace py = pybind11;
  registerErrors(module);
  module.attr("version") = std::to_string(radar::kVersionMajor) + "." + std::to_string(radar::kVersionMinor) + "." +
                           std::to_string(radar::kVersionPatch);
  module.attr("commit") = radar::tools::commit();
  py::list options;
  for (const radar::tools::QueryField& field : radar::tools::queryFields()) {
    if (field.cast) options.append(field.name);
  }
  module.attr("OPTIONS") = options;
  py::dict answers;
  for (const radar::tools::AnswerField& field : radar::tools::answerFields()) answers[field.name] = field.about;
  module.attr("ANSWERS") = answers;
  module.attr("CASTS") = typeOf(radar::tools::castsLayout(false));
  module.attr("SAMPLED_CASTS") = typeOf(radar::tools::castsLayout(true));
  module.attr("MAX_RESOLUTION") = radar::kMaxResolution;
  module.attr("MOST_SHOWN") = radar::tools::kMostShownQueries;
  py::class_<CastingScene> scene(module, "Scene");
  defineScene(module, scene);
  defineChains(module, scene);
  scene.def("cast", &castArrays).def("page", &castsPage);
  module.def("devices", &deviceReports);
  module.def("read_mesh", &readMesh);
  module.def("read_assembly", &readAssembly);
  module.def("turn_between", &turnsBetween);
  module.def("take_validation_messages", &takeValidationMessages);
}
