#include "python/scene_methods.h"

#include <pybind11/stl.h>

#include <optional>

#include "import/float_vertices.h"
#include "python/arrays.h"
#include "workloads/query_fields.h"

namespace radar::python {

namespace {

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

void edit(CastingScene& scene, const std::function<void(BasedScene&)>& change) {
  released([&] { scene.edit(change); });
}

template <class T>
std::vector<T> copyOf(const Array<T>& array) {
  return {array.data(), array.data() + array.size()};
}

BasedScene::Base baseFrom(const Array<double>& numbers) {
  requireCount(numbers, "base", 3);
  return {numbers.data()[0], numbers.data()[1], numbers.data()[2]};
}

MeshId addMesh(CastingScene& scene, const Array<float>& vertices, const Array<uint32_t>& faces,
               const Array<double>& base, double radius) {
  MeshId mesh = kNone;
  edit(scene, [&, positions = copyOf(vertices), indices = copyOf(faces), from = baseFrom(base)](BasedScene& to) {
    mesh = to.addMesh(positions, indices, from, radius);
  });
  return mesh;
}

/// Of each part, the heights, radii and corners of its rings.
using Rings = std::vector<std::vector<std::array<double, 3>>>;

Rings ringsOf(const Cutter& cutter) {
  Rings out;
  for (const auto& part : cutter.parts) {
    out.emplace_back();
    for (const Ring& ring : part) out.back().push_back({ring.height, ring.radius, ring.corner});
  }
  return out;
}

/// Refuses what makes a cutter in the words of its arguments.
template <class Make>
auto cutterBy(const Make& make) {
  try {
    return make();
  } catch (const Error& error) {
    throw Error(tools::problemOf(error));
  }
}

Rings cutterRings(const std::string& kind, const std::vector<double>& n) {
  return cutterBy([&] {
    return ringsOf(kind == "flat"        ? flatCutter(n.at(0), n.at(1))
                   : kind == "ball"      ? ballCutter(n.at(0), n.at(1))
                   : kind == "bull_nose" ? bullNoseCutter(n.at(0), n.at(1), n.at(2))
                   : kind == "cone"      ? coneCutter(n.at(0), n.at(1), n.at(2), n.at(3))
                                         : taperCutter(n.at(0), n.at(1), n.at(2), n.at(3)));
  });
}

MeshId addCutter(CastingScene& scene, const Rings& parts) {
  Cutter cutter;
  for (const auto& part : parts) {
    cutter.parts.emplace_back();
    for (const auto& [height, radius, corner] : part) cutter.parts.back().push_back({height, radius, corner});
  }
  return cutterBy([&] {
    MeshId mesh = kNone;
    edit(scene, [&](BasedScene& to) { mesh = to.addCutter(cutter); });
    return mesh;
  });
}

void setVertices(CastingScene& scene, MeshId mesh, const Array<float>& vertices, const Array<double>& base) {
  edit(scene, [mesh, positions = copyOf(vertices), from = baseFrom(base)](BasedScene& to) {
    to.setPositions(mesh, positions, from);
  });
}

/// What _engine.pyi says of float_vertices().
py::tuple floatVertices(const Array<double>& vertices, const Array<uint32_t>& faces) {
  const auto floats = released(
      [positions = copyOf(vertices), indices = copyOf(faces)] { return tools::floatVertices(positions, indices); });
  return py::make_tuple(arrayOf(floats.positions, {py::ssize_t(floats.positions.size() / 3), py::ssize_t(3)}),
                        Array<double>(3, floats.base.data()), floats.isSpoilt ? floats.change : 0);
}

Array<int64_t> add(CastingScene& scene, const Array<uint32_t>& meshes, const Array<double>& transforms,
                   const Array<uint32_t>& masks) {
  const auto count = static_cast<size_t>(meshes.size());
  requireCount(transforms, "transforms", 16 * count);
  requireCount(masks, "masks", count);
  std::vector<int64_t> ids;
  scene.edit([&](BasedScene& to) {
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
  edit(scene, [&, ids = copyOf(objects)](BasedScene& to) { to.setTransforms(ids, given); });
}

void setMotions(CastingScene& scene, const Array<uint32_t>& objects, const Array<double>& motions) {
  requireCount(motions, "motions", 3 * static_cast<size_t>(objects.size()));
  scene.edit([&](BasedScene& to) {
    for (py::ssize_t i = 0; i < objects.size(); ++i) {
      const double* motion = motions.data() + 3 * i;
      to.setMotion(objects.data()[i], {motion[0], motion[1], motion[2]});
    }
  });
}

void removeObjects(CastingScene& scene, const Array<uint32_t>& objects) {
  scene.edit([&](BasedScene& to) {
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
    const Transform& given = scene.based().given(id);
    transforms.insert(transforms.end(), given.m.begin(), given.m.end());
    transforms.insert(transforms.end(), {0, 0, 0, 1});
  }
  const auto count = py::ssize_t(ids.size());
  return py::make_tuple(arrayOf(ids, {count}), arrayOf(meshes, {count}), arrayOf(transforms, {count, 4, 4}),
                        arrayOf(masks, {count}), arrayOf(motions, {count, 3}));
}

}  // namespace

void defineScene(py::module_& module, py::class_<CastingScene>& scene) {
  scene.def(py::init(&makeScene), py::arg("device"), py::arg("pool"), py::arg("cpu_batch"), py::arg("threads"))
      .def("add_mesh", &addMesh, py::arg("vertices"), py::arg("faces"), py::arg("base"), py::arg("radius") = 0)
      .def("add_cutter", &addCutter)
      .def_static("cutter_rings", &cutterRings)
      .def("parts", [](const CastingScene& of, MeshId mesh) { return ringsOf(of.based().cutter(mesh)); })
      .def("radii",
           [](const CastingScene& of) {
             std::vector<double> radii;
             for (MeshId id = 0; id < of.scene().meshLimit(); ++id) radii.push_back(of.based().radius(id));
             return arrayOf(radii, {py::ssize_t(radii.size())});
           })
      .def("remove_mesh", [](CastingScene& to, MeshId mesh) { to.edit([&](BasedScene& in) { in.removeMesh(mesh); }); })
      .def("mesh",
           [](const CastingScene& of, MeshId id) {
             const MeshView mesh = of.scene().mesh(id);
             return meshArrays(mesh.positions, mesh.indices, of.based().base(id));
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
           [](const CastingScene& of) {
             std::vector<std::string> names;
             for (const Device& device : of.devices()) names.push_back(device.name());
             return names;
           })
      .def("take_losses", &CastingScene::takeLosses);
  module.def("first_singular", &firstSingular);
  module.def("float_vertices", &floatVertices);
}

}  // namespace radar::python
