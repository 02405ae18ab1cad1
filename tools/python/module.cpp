// The compiled half of the Python package: cyber_radar/_engine.pyi declares it, and the Python half checks every
// argument before it comes here.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <cmath>

#include "commit/commit.h"
#include "import/mesh_import.h"
#include "python/batch.h"
#include "python/page.h"
#include "view/page.h"
#include "workloads/query_fields.h"

namespace py = pybind11;

namespace radar::python {

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style>;

template <class T>
Array<T> arrayOf(const std::vector<T>& values, std::vector<py::ssize_t> shape) {
  return Array<T>(std::move(shape), values.data());
}

py::tuple meshArrays(std::span<const float> positions, std::span<const uint32_t> indices) {
  return py::make_tuple(Array<float>({py::ssize_t(positions.size() / 3), py::ssize_t(3)}, positions.data()),
                        Array<uint32_t>({py::ssize_t(indices.size() / 3), py::ssize_t(3)}, indices.data()));
}

/// The first three rows of a 4x4 matrix.
Transform transformFrom(const double* matrix) {
  Transform transform;
  std::copy(matrix, matrix + 12, transform.m.begin());
  return transform;
}

void requireCount(const py::array& array, const char* name, size_t count) {
  if (static_cast<size_t>(array.size()) == count) return;
  throw py::value_error(std::string(name) + ": expected " + std::to_string(count) + " numbers, got " +
                        std::to_string(array.size()));
}

// ------------------------------------------------------------------------------------------------------------ scenes

/// The first matrix that no object may have, and why; none if all may.
std::optional<std::pair<size_t, std::string>> firstSingular(const Array<double>& matrices) {
  for (size_t i = 0; 16 * i < static_cast<size_t>(matrices.size()); ++i) {
    std::string wrong = validate(transformFrom(matrices.data() + 16 * i));
    if (!wrong.empty()) return std::pair{i, std::move(wrong)};
  }
  return std::nullopt;
}

std::unique_ptr<CastingScene> makeScene(std::optional<uint32_t> device, std::optional<std::vector<uint32_t>> pool,
                                        std::optional<uint32_t> cpuBatch, uint32_t threads) {
  return std::make_unique<CastingScene>(tools::AnswererOptions{.device = device.value_or(kNone),
                                                               .pool = std::move(pool),
                                                               .cpuBatch = cpuBatch.value_or(kNone),
                                                               .threads = threads});
}

/// Works while other Python threads run, which may write to arrays: it must have copied what it reads of them.
template <class Work>
auto released(const Work& work) {
  const py::gil_scoped_release release;
  return work();
}

void edit(CastingScene& scene, const std::function<void(Scene&)>& change) {
  released([&] { scene.edit(change); });
}

template <class T>
std::vector<T> copyOf(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}

MeshId addMesh(CastingScene& scene, const Array<float>& vertices, const Array<uint32_t>& faces) {
  MeshId mesh = kNone;
  edit(scene, [&, positions = copyOf(vertices), indices = copyOf(faces)](Scene& to) {
    mesh = to.addMesh(positions, indices);
  });
  return mesh;
}

void setVertices(CastingScene& scene, MeshId mesh, const Array<float>& vertices) {
  edit(scene, [mesh, positions = copyOf(vertices)](Scene& to) { to.setPositions(mesh, positions); });
}

Array<int64_t> add(CastingScene& scene, const Array<uint32_t>& meshes, const Array<double>& transforms,
                   const Array<uint32_t>& masks) {
  const auto count = static_cast<size_t>(meshes.size());
  requireCount(transforms, "transforms", 16 * count);
  requireCount(masks, "masks", count);
  std::vector<int64_t> ids;
  scene.edit([&](Scene& to) {
    for (size_t i = 0; i < count; ++i) {
      ids.push_back(to.addObject({meshes.data()[i], transformFrom(transforms.data() + 16 * i), masks.data()[i]}));
    }
  });
  return arrayOf(ids, {py::ssize_t(count)});
}

void setTransforms(CastingScene& scene, const Array<uint32_t>& objects, const Array<double>& transforms) {
  requireCount(transforms, "transforms", 16 * static_cast<size_t>(objects.size()));
  std::vector<Transform> given;
  for (py::ssize_t i = 0; i < objects.size(); ++i) given.push_back(transformFrom(transforms.data() + 16 * i));
  edit(scene, [&, ids = copyOf(objects)](Scene& to) { to.setTransforms(ids, given); });
}

void setMotions(CastingScene& scene, const Array<uint32_t>& objects, const Array<double>& motions) {
  requireCount(motions, "motions", 3 * static_cast<size_t>(objects.size()));
  scene.edit([&](Scene& to) {
    for (py::ssize_t i = 0; i < objects.size(); ++i) {
      const double* motion = motions.data() + 3 * i;
      to.setMotion(objects.data()[i], {motion[0], motion[1], motion[2]});
    }
  });
}

void removeObjects(CastingScene& scene, const Array<uint32_t>& objects) {
  scene.edit([&](Scene& to) {
    for (py::ssize_t i = 0; i < objects.size(); ++i) to.removeObject(objects.data()[i]);
  });
}

std::vector<MeshId> meshIds(const CastingScene& scene) {
  std::vector<MeshId> ids;
  for (MeshId id = 0; id < scene.scene().meshLimit(); ++id) {
    if (scene.scene().hasMesh(id)) ids.push_back(id);
  }
  return ids;
}

Array<int64_t> objectIds(const CastingScene& scene) {
  std::vector<int64_t> ids;
  for (ObjectId id = 0; id < scene.scene().objectLimit(); ++id) {
    if (scene.scene().hasObject(id)) ids.push_back(id);
  }
  return arrayOf(ids, {py::ssize_t(ids.size())});
}

/// Ids, meshes, transforms, masks and motions of all objects.
py::tuple objects(const CastingScene& scene) {
  std::vector<int64_t> ids, meshes;
  std::vector<double> transforms, motions;
  std::vector<uint32_t> masks;
  for (ObjectId id = 0; id < scene.scene().objectLimit(); ++id) {
    if (!scene.scene().hasObject(id)) continue;
    const Object& object = scene.scene().object(id);
    ids.push_back(id);
    meshes.push_back(object.mesh);
    masks.push_back(object.mask);
    motions.insert(motions.end(), object.motion.begin(), object.motion.end());
    transforms.insert(transforms.end(), object.worldFromMesh.m.begin(), object.worldFromMesh.m.end());
    transforms.insert(transforms.end(), {0, 0, 0, 1});
  }
  const auto count = py::ssize_t(ids.size());
  return py::make_tuple(arrayOf(ids, {count}), arrayOf(meshes, {count}), arrayOf(transforms, {count, 4, 4}),
                        arrayOf(masks, {count}), arrayOf(motions, {count, 3}));
}

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

template <class T>
T* output(const py::dict& arrays, const char* name, size_t count) {
  if (!arrays.contains(name)) throw py::value_error(std::string("out: expected an array \"") + name + "\"");
  const py::object array = arrays[name];
  if (!py::isinstance<Array<T>>(array)) throw py::value_error(std::string("out: ") + name + ": another type");
  auto typed = py::reinterpret_borrow<Array<T>>(array);
  requireCount(typed, name, count);
  return typed.mutable_data();
}

BatchOutput outputFrom(const py::dict& arrays, size_t count) {
  BatchOutput to;
  to.distance = output<double>(arrays, "distance", count);
  to.lo = output<double>(arrays, "lo", count);
  to.hi = output<double>(arrays, "hi", count);
  to.fraction = output<double>(arrays, "fraction", count);
  to.status = output<uint8_t>(arrays, "status", count);
  to.tier = output<uint8_t>(arrays, "tier", count);
  to.detected = output<int8_t>(arrays, "detected", count);
  to.object = output<int64_t>(arrays, "object", count);
  to.triangles = output<int64_t>(arrays, "triangles", 2 * count);
  to.features = output<uint8_t>(arrays, "features", 2 * count);
  to.point = output<double>(arrays, "point", 3 * count);
  to.normal = output<double>(arrays, "normal", 3 * count);
  to.gap = output<double>(arrays, "gap", count);
  if (arrays.contains("paper_min_l")) to.paperMinL = output<double>(arrays, "paper_min_l", count);
  if (arrays.contains("resolution")) to.resolution = output<uint32_t>(arrays, "resolution", count);
  return to;
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
  throw py::value_error(std::string(field.python) + ": expected " + expectedFor(field) + ", got " +
                        std::string(py::repr(value)));
}

tools::AnswerMode modeFrom(const py::dict& options) {
  const auto mode = options["mode"].cast<std::string>();
  if (mode == "sampled") return tools::AnswerMode::sampled;
  return mode == "reference" ? tools::AnswerMode::reference : tools::AnswerMode::contact;
}

Query optionsFrom(const py::dict& options) {
  tools::QuerySpec query;
  for (const tools::QueryField& field : tools::queryFields()) {
    if (*field.python != 0) readField(field, options[field.python], query);
  }
  query.resolution = options["resolution"].cast<uint32_t>();
  if (query.hits > 1 && query.anyHit) throw py::value_error("hits: expected 1 with any_hit");
  const tools::QueryField* const exact = exactOnly(query);
  if (exact && modeFrom(options) == tools::AnswerMode::sampled) {
    throw py::value_error("mode: expected \"contact\" or \"reference\" with " + std::string(exact->python) +
                          ", got \"sampled\"");
  }
  return query;
}

/// What _engine.pyi says of cast().
py::tuple listsFor(const Query& options, BatchLists&& found, const py::function& makeArrays) {
  py::object hits = py::none(), overlapping = py::none();
  const auto whole = [](const std::vector<int64_t>& values) { return arrayOf(values, {py::ssize_t(values.size())}); };
  if (options.hits > 1) {
    const size_t count = found.hits.size();
    const py::dict arrays = makeArrays(count);
    const BatchOutput to = outputFrom(arrays, count);
    for (size_t i = 0; i < count; ++i) to.write(i, found.hits[i]);
    hits = py::make_tuple(arrays, whole(found.hitOffsets));
  }
  if (options.skipOverlapping) {
    overlapping = py::make_tuple(whole(found.overlapping), whole(found.overlappingOffsets));
  }
  py::dict reasons;
  for (const auto& [reason, which] : found.reasons) {
    reasons[py::str(reason)] = arrayOf(which, {py::ssize_t(which.size())});
  }
  return py::make_tuple(hits, overlapping, reasons);
}

py::tuple castArrays(CastingScene& scene, const std::vector<size_t>& shape, const py::dict& arguments,
                     const py::dict& options, const py::dict& out, const py::function& makeArrays,
                     const py::object& afterChunk) {
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
  py::array distances;
  if (!arguments["distances"].is_none()) {
    distances = argument("distances");
    input.distances = perQuery<double>(distances, shape, 1, "distances");
  }
  std::vector<py::array> each;  // keeps the arrays alive
  const auto readEach = [&]<class T>(const char* name, PerQuery& to, T) {
    if (arguments.contains(name)) to = perQuery<T>(each.emplace_back(argument(name)), shape, 1, name);
  };
  readEach("ignore_leaving", input.leaving, false);
  readEach("slack", input.slacks, 0.0);
  readEach("tolerance", input.tolerances, 0.0);
  readEach("clearance", input.clearances, 0.0);
  readEach("hits", input.hits, uint32_t{});
  input.options = optionsFrom(options);
  input.mode = modeFrom(options);
  const BatchOutput output = outputFrom(out, input.count());
  BatchLists found;
  {
    const py::gil_scoped_release release;
    found = cast(scene, input, output, [&](size_t done) {
      const py::gil_scoped_acquire acquire;
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!afterChunk.is_none()) afterChunk(done);
    });
  }
  return listsFor(input.options, std::move(found), makeArrays);
}

/// What _engine.pyi says of page().
std::string castsPage(const CastingScene& scene, const std::map<uint32_t, std::string>& objectNames,
                      const std::string& title, uint64_t count, const std::vector<std::string>& names,
                      const py::dict& arrays, const std::map<uint32_t, std::string>& reasons,
                      const tools::LeftOut& left) {
  const size_t shown = names.size();
  ShownCasts casts{
      .count = count, .names = names, .answers = outputFrom(arrays, shown), .reasons = reasons, .left = left};
  casts.meshes = output<uint32_t>(arrays, "mesh", shown);
  casts.poses = output<double>(arrays, "poses", 16 * shown);
  casts.directions = output<double>(arrays, "displacements", 3 * shown);
  casts.distances = output<double>(arrays, "distances", shown);
  casts.clearances = output<double>(arrays, "clearance", shown);
  casts.anyHit = output<uint8_t>(arrays, "any_hit", shown);
  const auto excluded = arrays["exclude_from_each"].cast<Array<int64_t>>();
  casts.excludedCount = static_cast<size_t>(excluded.shape(1));
  casts.excluded = excluded.data();
  return pageOf(scene, objectNames, title, casts);
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

py::tuple readMesh(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  const tools::FileMesh mesh = released([&] { return tools::readMesh(file, warnings); });
  py::tuple arrays = meshArrays(mesh.positions, mesh.indices);
  if (mesh.base != std::array<double, 3>{}) {
    std::vector<double> placed;
    for (size_t i = 0; i < mesh.positions.size(); ++i) placed.push_back(mesh.base[i % 3] + double(mesh.positions[i]));
    arrays = py::make_tuple(arrayOf(placed, {py::ssize_t(mesh.vertexCount()), py::ssize_t(3)}), arrays[1]);
  }
  return py::make_tuple(arrays, warnings);
}

py::tuple readAssembly(const std::filesystem::path& file) {
  std::vector<std::string> warnings;
  const tools::Assembly assembly = released([&] { return tools::readAssembly(file, warnings); });
  py::list meshes, names;
  std::vector<uint32_t> placed;
  std::vector<double> transforms;
  for (const tools::MeshData& mesh : assembly.meshes) meshes.append(meshArrays(mesh.positions, mesh.indices));
  for (const tools::Assembly::Part& part : assembly.parts) {
    // A file may hold a name in any encoding.
    names.append(py::reinterpret_steal<py::str>(
        PyUnicode_DecodeUTF8(part.name.data(), py::ssize_t(part.name.size()), "replace")));
    placed.push_back(part.mesh);
    transforms.insert(transforms.end(), part.fileFromMesh.m.begin(), part.fileFromMesh.m.end());
    transforms.insert(transforms.end(), {0, 0, 0, 1});
  }
  const auto count = py::ssize_t(placed.size());
  return py::make_tuple(meshes, names, arrayOf(placed, {count}), arrayOf(transforms, {count, 4, 4}), warnings);
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
  registerErrors(module);
  module.attr("version") = std::to_string(radar::kVersionMajor) + "." + std::to_string(radar::kVersionMinor) + "." +
                           std::to_string(radar::kVersionPatch);
  module.attr("commit") = radar::tools::commit();
  py::list options;
  for (const radar::tools::QueryField& field : radar::tools::queryFields()) {
    if (*field.python != 0) options.append(field.python);
  }
  module.attr("OPTIONS") = options;
  module.attr("MAX_RESOLUTION") = radar::kMaxResolution;
  module.attr("MOST_SHOWN") = radar::tools::kMostShownQueries;
  py::class_<CastingScene>(module, "Scene")
      .def(py::init(&makeScene), py::arg("device"), py::arg("pool"), py::arg("cpu_batch"), py::arg("threads"))
      .def("add_mesh", &addMesh)
      .def("remove_mesh",
           [](CastingScene& scene, radar::MeshId mesh) { scene.edit([&](radar::Scene& in) { in.removeMesh(mesh); }); })
      .def("mesh",
           [](const CastingScene& scene, radar::MeshId id) {
             const radar::MeshView mesh = scene.scene().mesh(id);
             return meshArrays(mesh.positions, mesh.indices);
           })
      .def("mesh_ids", &meshIds)
      .def("add", &add)
      .def("set_transforms", &setTransforms)
      .def("set_motions", &setMotions)
      .def("set_vertices", &setVertices)
      .def("remove", &removeObjects)
      .def("objects", &objects)
      .def("object_ids", &objectIds)
      .def("device_names",
           [](const CastingScene& scene) {
             std::vector<std::string> names;
             for (const radar::Device& device : scene.devices()) names.push_back(device.name());
             return names;
           })
      .def("take_losses", &CastingScene::takeLosses)
      .def("cast", &castArrays)
      .def("page", &castsPage);
  module.def("first_singular", &firstSingular);
  module.def("devices", &deviceReports);
  module.def("read_mesh", &readMesh);
  module.def("read_assembly", &readAssembly);
  module.def("take_validation_messages", &takeValidationMessages);
}
