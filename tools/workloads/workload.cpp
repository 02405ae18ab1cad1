#include "workloads/workload.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

namespace radar::tools {

uint32_t Workload::objectCount(uint32_t scene) const {
  const SceneSpec& spec = scenes[scene];
  const size_t still = spec.base ? scenes[*spec.base].instances.size() : 0;
  return static_cast<uint32_t>(still + spec.instances.size());
}

Query toQuery(const QuerySpec& spec, radar::Mode mode, uint32_t resolution) {
  Query query;
  query.mesh = spec.sensor.mesh;
  query.worldFromMesh = spec.sensor.worldFromMesh;
  query.direction = spec.direction;
  query.distance = spec.distance;
  query.mode = mode;
  query.exclude = spec.exclude;
  query.mask = spec.mask;
  query.anyHit = spec.anyHit;
  query.resolution = resolution;
  return query;
}

double sensorSize(const Scene& scene, const Query& query) {
  const MeshView mesh = scene.mesh(query.mesh);
  std::array<double, 3> low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  for (const uint32_t vertex : mesh.indices) {
    const std::array<double, 3> p = transformPoint(query.worldFromMesh, &mesh.positions[3 * size_t{vertex}]);
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
}

std::vector<Batch> batchesOf(const Workload& workload) {
  std::vector<Batch> batches;
  std::map<std::pair<uint32_t, uint64_t>, size_t> places;
  for (uint32_t i = 0; i < workload.queries.size(); ++i) {
    const QuerySpec& query = workload.queries[i];
    const auto [place, isNew] = places.try_emplace({query.scene, query.batch}, batches.size());
    if (isNew) batches.push_back({query.scene, {}});
    batches[place->second].queries.push_back(i);
  }
  return batches;
}

void replaceBy(const Workload& workload, uint32_t scene, Scene& to) {
  for (ObjectId id = 0; id < to.objectLimit(); ++id) {
    if (to.hasObject(id)) to.removeObject(id);
  }
  for (MeshId id = 0; id < to.meshLimit(); ++id) {
    if (to.hasMesh(id)) to.removeMesh(id);
  }
  for (const MeshData& mesh : workload.meshes) to.addMesh(mesh.positions, mesh.indices);
  const SceneSpec& spec = workload.scenes[scene];
  const std::map<uint32_t, uint32_t> masks(spec.masks.begin(), spec.masks.end());
  uint32_t object = 0;
  const auto add = [&](const std::vector<Instance>& instances) {
    for (const Instance& instance : instances) {
      const auto mask = masks.find(object++);
      to.addObject({instance.mesh, instance.worldFromMesh, mask == masks.end() ? ~0u : mask->second});
    }
  };
  if (spec.base) add(workload.scenes[*spec.base].instances);
  add(spec.instances);
}

ScenePlayer::ScenePlayer(const Workload& workload) : workload_(workload) {
  for (const MeshData& mesh : workload.meshes) scene_.addMesh(mesh.positions, mesh.indices);
}

void ScenePlayer::show(uint32_t scene) {
  if (shown_ == scene) return;
  const SceneSpec& spec = workload_.scenes[scene];
  const SceneSpec* before = shown_ ? &workload_.scenes[*shown_] : nullptr;
  static const std::vector<Instance> kNothing;
  const std::vector<Instance>& still = spec.base ? workload_.scenes[*spec.base].instances : kNothing;
  const uint32_t stillCount = static_cast<uint32_t>(still.size());
  const uint32_t count = workload_.objectCount(scene);

  for (uint32_t id = scene_.objectLimit(); id > count; --id) {
    if (scene_.hasObject(id - 1)) scene_.removeObject(id - 1);
  }
  std::map<uint32_t, uint32_t> masks(spec.masks.begin(), spec.masks.end());
  const auto maskOf = [&](uint32_t object) {
    const auto found = masks.find(object);
    return found == masks.end() ? ~0u : found->second;
  };
  // A step of a sequence costs what moves in it, not what stands still.
  const bool sameBase = before && spec.base && before->base == spec.base && before->masks == spec.masks;
  for (uint32_t i = sameBase ? stillCount : 0; i < stillCount; ++i) showObject(i, still[i], maskOf(i));
  for (uint32_t i = stillCount; i < count; ++i) showObject(i, spec.instances[i - stillCount], maskOf(i));
  shown_ = scene;
}

void ScenePlayer::showObject(uint32_t object, const Instance& instance, uint32_t mask) {
  if (scene_.hasObject(object)) {
    const Object& present = scene_.object(object);
    if (present.mesh == instance.mesh && present.mask == mask) {
      if (present.worldFromMesh != instance.worldFromMesh) scene_.setTransform(object, instance.worldFromMesh);
      return;
    }
    scene_.removeObject(object);
  }
  [[maybe_unused]] const ObjectId id = scene_.addObject({instance.mesh, instance.worldFromMesh, mask});
  assert(id == object && "the least free id is given next");
}

}  // namespace radar::tools
