#include "support/scene_model.h"

#include <algorithm>

#include "scene/scene.h"

namespace radar::test {

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

Bounds boundsOf(const radar::Mesh& mesh) {
  Bounds bounds;
  for (size_t k = 0; k < 3; ++k) {
    bounds.lo[k] = mesh.box.lo[k] + mesh.origin[k];
    bounds.hi[k] = mesh.box.hi[k] + mesh.origin[k];
  }
  return bounds;
}

}  // namespace

bool SceneModel::operator==(const SceneModel& other) const {
  const auto sameMesh = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.positions == b.second.positions && a.second.indices == b.second.indices;
  };
  const auto sameObject = [](const auto& a, const auto& b) {
    return a.first == b.first && a.second.mesh == b.second.mesh && a.second.worldFromMesh == b.second.worldFromMesh &&
           a.second.mask == b.second.mask && a.second.motion == b.second.motion;
  };
  return std::ranges::equal(meshes, other.meshes, sameMesh) && std::ranges::equal(objects, other.objects, sameObject);
}

Scene SceneModel::build() const {
  Scene scene;
  const float point[] = {0, 0, 0};
  const uint32_t corners[] = {0, 0, 0};
  addAll(
      meshes, [&](const Mesh& mesh) { scene.addMesh(mesh.positions, mesh.indices, mesh.bounds); },
      [&] { scene.addMesh(point, corners); }, [&](MeshId id) { scene.removeMesh(id); });
  addAll(
      objects, [&](const Object& object) { scene.addObject(object); },
      [&] { scene.addObject({.mesh = meshes.begin()->first}); }, [&](ObjectId id) { scene.removeObject(id); });
  return scene;
}

SceneModel SceneModel::of(const Scene& scene) {
  SceneModel model;
  for (MeshId id = 0; id < scene.meshLimit(); ++id) {
    if (!scene.hasMesh(id)) continue;
    const MeshView mesh = scene.mesh(id);
    Mesh& copy = model.meshes[id];
    copy.positions.assign(mesh.positions.begin(), mesh.positions.end());
    copy.indices.assign(mesh.indices.begin(), mesh.indices.end());
    if (const radar::Mesh& derived = scene.impl().meshes[id]; derived.hasBounds) copy.bounds = boundsOf(derived);
  }
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id)) model.objects[id] = scene.object(id);
  }
  return model;
}

}  // namespace radar::test
