#include "soak/model.h"

namespace radar::soak {

namespace {

/// Adds items of `all` under their numbers: `fill` stands in for those that are missing.
template <class Items, class Add, class Fill, class Remove>
void addAll(const Items& all, const Add& add, const Fill& fill, const Remove& remove) {
  std::vector<uint32_t> gone;
  for (uint32_t id = 0; !all.empty() && id <= all.rbegin()->first; ++id) {
    if (const auto found = all.find(id); found != all.end()) {
      add(found->second);
    } else {
      fill();
      gone.push_back(id);
    }
  }
  for (const uint32_t id : gone) remove(id);
}

}  // namespace

Scene Model::build() const {
  Scene scene;
  const float point[] = {0, 0, 0};
  const uint32_t corners[] = {0, 0, 0};
  addAll(
      meshes, [&](const Mesh& mesh) { scene.addMesh(mesh.positions, mesh.indices); },
      [&] { scene.addMesh(point, corners); }, [&](MeshId id) { scene.removeMesh(id); });
  addAll(
      objects, [&](const Object& object) { scene.addObject(object); },
      [&] { scene.addObject({.mesh = meshes.begin()->first}); }, [&](ObjectId id) { scene.removeObject(id); });
  return scene;
}

Model Model::of(const Scene& scene) {
  Model model;
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    if (!scene.hasMesh(id)) continue;
    const MeshView mesh = scene.mesh(id);
    model.meshes[id] = {{mesh.positions.begin(), mesh.positions.end()}, {mesh.indices.begin(), mesh.indices.end()}};
  }
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id)) model.objects[id] = scene.object(id);
  }
  return model;
}

}  // namespace radar::soak
