#include "workloads/workload.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <tuple>

#include "workloads/vectors.h"

namespace radar::tools {

namespace {

/// Makes the objects of one scene.
class Objects {
 public:
  Objects(const Workload& workload, uint32_t scene) : workload_(workload), scene_(scene) {
    const SceneSpec& spec = workload.scenes[scene];
    masks_.insert(spec.masks.begin(), spec.masks.end());
    motions_.insert(spec.motions.begin(), spec.motions.end());
  }
  Object operator[](uint32_t number) const {
    const Instance& instance = workload_.instance(scene_, number);
    const auto mask = masks_.find(number);
    const auto motion = motions_.find(number);
    return {instance.mesh, instance.worldFromMesh, mask == masks_.end() ? ~0u : mask->second,
            motion == motions_.end() ? std::array<double, 3>{} : motion->second};
  }

 private:
  const Workload& workload_;
  uint32_t scene_;
  std::map<uint32_t, uint32_t> masks_;
  std::map<uint32_t, std::array<double, 3>> motions_;
};

}  // namespace

std::span<const Instance> Workload::baseOf(uint32_t scene) const {
  const std::optional<uint32_t>& base = scenes[scene].base;
  return base ? std::span<const Instance>(scenes[*base].instances) : std::span<const Instance>();
}

uint32_t Workload::objectCount(uint32_t scene) const {
  return static_cast<uint32_t>(baseOf(scene).size() + scenes[scene].instances.size());
}

const Instance& Workload::instance(uint32_t scene, uint32_t object) const {
  const std::span<const Instance> base = baseOf(scene);
  return object < base.size() ? base[object] : scenes[scene].instances[object - base.size()];
}

std::vector<std::string> Workload::objectNames(uint32_t scene) const {
  const SceneSpec& own = scenes[scene];
  std::vector<std::string> names;
  if (own.base) names = scenes[*own.base].names;
  if (names.empty() && own.names.empty()) return {};
  names.resize(baseOf(scene).size());
  names.insert(names.end(), own.names.begin(), own.names.end());
  names.resize(objectCount(scene));
  return names;
}

std::vector<Query> queriesOf(std::span<const QuerySpec> specs, uint32_t resolution) {
  std::vector<Query> queries(specs.begin(), specs.end());
  for (Query& query : queries) query.resolution = resolution;
  return queries;
}

double sensorSize(const Scene& scene, const Query& query) {
  return boundsOf(scene.mesh(query.mesh), query.worldFromMesh).longest();
}

ChainQuery chainQueryOf(const QuerySpec& query) {
  return {.from = query.chain->from,
          .to = query.chain->to,
          .worldFromBase = query.worldFromMesh,
          .anyHit = query.anyHit,
          .exclude = query.exclude,
          .mask = query.mask,
          .clearance = query.clearance,
          .tolerance = query.tolerance};
}

std::vector<Batch> batchesOf(std::span<const QuerySpec> specs, uint32_t resolution, AnswerMode mode) {
  std::vector<Batch> batches;
  std::map<std::tuple<uint32_t, uint64_t, AnswerMode, std::optional<uint32_t>>, size_t> places;
  for (uint32_t i = 0; i < specs.size(); ++i) {
    const AnswerMode own = specs[i].mode.value_or(mode);
    std::optional<uint32_t> chain;
    if (specs[i].chain) chain = specs[i].chain->chain;
    const auto [place, isNew] = places.try_emplace({specs[i].scene, specs[i].batch, own, chain}, batches.size());
    if (isNew) batches.push_back({.scene = specs[i].scene, .mode = own, .chain = chain});
    Batch& batch = batches[place->second];
    batch.numbers.push_back(i);
    if (chain) {
      batch.moves.push_back(chainQueryOf(specs[i]));
      continue;
    }
    batch.queries.push_back(specs[i]);
    batch.queries.back().resolution = resolution;
  }
  return batches;
}

namespace {

void add(const MeshData& mesh, Scene& to) {
  if (mesh.cutter.parts.empty()) {
    to.addMesh(mesh.positions, mesh.indices);
  } else {
    to.addCutter(mesh.cutter);
  }
}

}  // namespace

void replaceBy(const Workload& workload, uint32_t scene, Scene& to) {
  for (ObjectId id = 0; id < to.objectLimit(); ++id) {
    if (to.hasObject(id)) to.removeObject(id);
  }
  for (MeshId id = 0; id < to.meshLimit(); ++id) {
    if (to.hasMesh(id)) to.removeMesh(id);
  }
  for (const MeshData& mesh : workload.meshes) add(mesh, to);
  for (const Deformation& deformed : workload.scenes[scene].deforms) to.setPositions(deformed.mesh, deformed.positions);
  const Objects objects(workload, scene);
  for (uint32_t i = 0; i < workload.objectCount(scene); ++i) to.addObject(objects[i]);
}

ScenePlayer::ScenePlayer(const Workload& workload) : workload_(workload) {
  for (const MeshData& mesh : workload.meshes) add(mesh, scene_);
}

void ScenePlayer::show(uint32_t scene) {
  if (shown_ == scene) return;
  const SceneSpec& spec = workload_.scenes[scene];
  const SceneSpec* before = shown_ ? &workload_.scenes[*shown_] : nullptr;
  const uint32_t count = workload_.objectCount(scene);
  for (uint32_t id = scene_.objectLimit(); id > count; --id) {
    if (scene_.hasObject(id - 1)) scene_.removeObject(id - 1);
  }
  deform(scene);
  const Objects objects(workload_, scene);
  // The objects of a base that stays need no comparison, so that a step costs only what moves in it.
  const bool sameBase = before && spec.base && before->base == spec.base && before->masks == spec.masks &&
                        before->motions == spec.motions;
  const size_t first = sameBase ? workload_.baseOf(scene).size() : 0;
  for (auto i = static_cast<uint32_t>(first); i < count; ++i) showObject(objects[i], i);
  shown_ = scene;
}

void ScenePlayer::deform(uint32_t scene) {
  const std::vector<Deformation>& now = workload_.scenes[scene].deforms;
  if (shown_) {
    for (const Deformation& before : workload_.scenes[*shown_].deforms) {
      if (std::ranges::count(now, before.mesh, &Deformation::mesh) == 0) {
        scene_.setPositions(before.mesh, workload_.meshes[before.mesh].positions);
      }
    }
  }
  for (const Deformation& deformed : now) scene_.setPositions(deformed.mesh, deformed.positions);
}

void ScenePlayer::showObject(const Object& object, ObjectId id) {
  if (scene_.hasObject(id)) {
    const Object& present = scene_.object(id);
    if (present.mesh == object.mesh && present.mask == object.mask) {
      if (present.worldFromMesh != object.worldFromMesh) scene_.setTransform(id, object.worldFromMesh);
      scene_.setMotion(id, object.motion);
      return;
    }
    scene_.removeObject(id);
  }
  [[maybe_unused]] const ObjectId given = scene_.addObject(object);
  assert(given == id && "the least free id is given next");
}

}  // namespace radar::tools
