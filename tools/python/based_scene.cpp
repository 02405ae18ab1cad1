#include "python/based_scene.h"

#include <algorithm>

#include "import/float_vertices.h"

namespace radar::python {

Transform BasedScene::placed(MeshId mesh, const Transform& given) const {
  return mesh < bases_.size() ? tools::aboutBase(given, bases_[mesh]) : given;
}

const Transform& BasedScene::given(ObjectId object) const {
  const auto found = given_.find(object);
  return found == given_.end() ? scene_.object(object).worldFromMesh : found->second;
}

MeshId BasedScene::addMesh(std::span<const float> positions, std::span<const uint32_t> indices, const Base& base,
                           double radius) {
  return entered(scene_.addMesh(positions, indices), base, radius);
}

MeshId BasedScene::entered(MeshId mesh, const Base& base, double radius, const Cutter& cutter) {
  bases_.resize(std::max<size_t>(bases_.size(), mesh + 1));
  bases_[mesh] = base;
  radii_.resize(bases_.size());
  radii_[mesh] = radius;
  cutters_.resize(bases_.size());
  cutters_[mesh] = cutter;
  return mesh;
}

void BasedScene::setPositions(MeshId mesh, std::span<const float> positions, const Base& base) {
  scene_.setPositions(mesh, positions);
  if (base == bases_.at(mesh)) return;
  bases_[mesh] = base;
  std::vector<ObjectId> objects;
  std::vector<Transform> poses;
  for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
    if (!scene_.hasObject(id) || scene_.object(id).mesh != mesh) continue;
    objects.push_back(id);
    poses.push_back(given(id));
  }
  setTransforms(objects, poses);
}

ObjectId BasedScene::addObject(const Object& object) {
  Object moved = object;
  moved.worldFromMesh = placed(object.mesh, object.worldFromMesh);
  const ObjectId id = scene_.addObject(moved);
  if (moved.worldFromMesh != object.worldFromMesh) given_[id] = object.worldFromMesh;
  return id;
}

void BasedScene::setTransforms(std::span<const ObjectId> objects, std::span<const Transform> given) {
  std::vector<Transform> poses(given.begin(), given.end());
  for (size_t i = 0; i < objects.size(); ++i) poses[i] = placed(scene_.object(objects[i]).mesh, given[i]);
  scene_.setTransforms(objects, poses);
  for (size_t i = 0; i < objects.size(); ++i) {
    given_.erase(objects[i]);
    if (poses[i] != given[i]) given_[objects[i]] = given[i];
  }
}

void BasedScene::removeObject(ObjectId object) {
  scene_.removeObject(object);
  given_.erase(object);
}

}  // namespace radar::python
