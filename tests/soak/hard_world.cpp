#include <algorithm>
#include <cmath>

#include "fuzz/scene_calls.h"
#include "soak/world.h"
#include "support/world.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"
#include "workloads/interlocking.h"
#include "workloads/random_shapes.h"

namespace radar::soak {

namespace {

using tools::Random;
using tools::operator-;
using tools::operator*;

tools::Workload mixedFamilies(Random& random) {
  std::vector<tools::HardCase> cases;
  for (int i = 0; i < 24; ++i) {
    const auto& families = tools::hardFamilies();
    const tools::HardFamily& family = families[random.below(static_cast<uint32_t>(families.size()))];
    cases.push_back(tools::hardCase(family, random.below(1u << 30), random.below(1000)));
  }
  return tools::sceneOf(cases, random.oneIn(2) ? tools::Company::mixed : tools::Company::isolated);
}

struct Source {
  std::string name;
  tools::Workload workload;
};

Source source(Random& random) {
  const uint64_t seed = random.below(1u << 30);
  switch (random.below(6)) {
    case 0:
      return {"families", mixedFamilies(random)};
    case 1: {
      const tools::Interlocking kind = tools::kInterlocking[random.below(3)];
      return {nameOf(kind), makeWorkload(tools::InterlockingPairs{.kind = kind, .sensors = 2, .seed = seed})};
    }
    case 2: {
      const double origin = random.oneIn(2) ? 0 : random.magnitude(0, 9);
      return {
          "soups at " + std::to_string(origin),
          makeWorkload(tools::Soups{.objects = 20, .sensors = 16, .triangles = 12, .origin = origin, .seed = seed})};
    }
    default: {
      const auto& families = tools::hardFamilies();
      const tools::HardFamily& family = families[random.below(static_cast<uint32_t>(families.size()))];
      const auto company = random.oneIn(2) ? tools::Company::mixed : tools::Company::isolated;
      return {family.name, tools::hardScene(family, seed, 0, 16, company)};
    }
  }
}

void aimAt(Query& query, const Transform& target) {
  query.direction = test::placeOf(target) - test::placeOf(query.worldFromMesh);
  query.distance = tools::lengthOf(query.direction);
}

/// What is asked about the contact.
void setQuestion(Query& query, double size, bool isLarge, Random& random) {
  switch (random.below(8)) {
    case 0:
      query.anyHit = true;
      break;
    case 1:
      query.hits = 2 + random.below(3);
      break;
    case 2:
      query.hits = kAllHits;
      break;
    case 3:
      // Of large meshes a wide one would concern millions of pairs.
      query.clearance = random.magnitude(-8, isLarge ? -3 : 1) * size;
      if (random.oneIn(3)) query.tolerance = random.magnitude(-12, 0) * query.clearance;
      break;
    default:
      break;
  }
}

/// Moves a pose by a millionth of `size` up to all of it, or by whole steps.
Transform moved(Transform pose, double size, Random& random) {
  const tools::Vec3 step = random.oneIn(2) ? random.axis() : random.magnitude(-6, 0) * random.direction();
  for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] += size * step[k];
  return pose;
}

/// A query with some of what mode contact offers; not always a valid one.
Query varied(Query query, const Scene& scene, Random& random) {
  const double size = tools::sensorSize(scene, query);
  const ObjectId any = random.below(std::max(1u, scene.objectLimit()));
  if (random.oneIn(3)) query.worldFromMesh = moved(query.worldFromMesh, size, random);
  if (random.oneIn(4) && scene.hasObject(any)) aimAt(query, scene.object(any).worldFromMesh);
  if (random.oneIn(8)) query.distance *= random.oneIn(2) ? 0 : random.magnitude(-3, 3);
  if (random.oneIn(6) && query.distance > 0) tools::takeStep(query);
  setQuestion(query, size, scene.mesh(query.mesh).triangleCount() > 200, random);
  if (random.oneIn(5)) query.ignoreLeaving = !query.ignoreLeaving;
  if (random.oneIn(6)) query.skipOverlapping = !query.skipOverlapping;
  query.closest = query.exit = random.oneIn(6) && !query.ignoreLeaving && !query.turn;
  if ((query.ignoreLeaving || query.skipOverlapping) && random.oneIn(4)) query.slack = random.magnitude(-14, -3) * size;
  if (random.oneIn(6)) query.mask = random.oneIn(2) ? ~0u : 1u << random.below(32);
  if (random.oneIn(6)) query.exclude.push_back(any);
  std::erase_if(query.exclude, [&](ObjectId id) { return !scene.hasObject(id); });
  return query;
}

class HardWorld : public World {
 public:
  explicit HardWorld(Random& random) : random_(random), source_(source(random)) {
    const tools::Workload& workload = source_.workload;
    tools::replaceBy(workload, 0, scene_);
    isMoving_ = random_.oneIn(3);
    if (isMoving_) tools::setMotions(workload, random_, scene_);
    ownMeshes_ = static_cast<uint32_t>(workload.meshes.size());
    asked_ = tools::queriesOf(workload.queries);
    for (const Query& query : asked_) sizes_.push_back(tools::sensorSize(scene_, query));
  }
  const Scene& scene() const override { return scene_; }
  void edit() override {
    for (uint32_t count = 1 + random_.below(3); count > 0; --count) editOnce();
  }
  std::vector<Query> queries(uint32_t most) override {
    std::vector<Query> all;
    while (all.size() < most) {
      const Query& like = asked_[random_.below(static_cast<uint32_t>(asked_.size()))];
      Query query = varied(like, scene_, random_);
      if (validate(query, scene_).empty()) {
        all.push_back(std::move(query));
      } else {
        --most;
      }
    }
    return all;
  }
  std::string name() const override { return source_.name; }

 private:
  double size() { return sizes_[random_.below(static_cast<uint32_t>(sizes_.size()))]; }
  /// There is always one.
  ObjectId anyObject() {
    for (;;) {
      const ObjectId id = random_.below(scene_.objectLimit());
      if (scene_.hasObject(id)) return id;
    }
  }
  MeshId anyMesh() { return scene_.object(anyObject()).mesh; }
  std::vector<ObjectId> allObjects() const {
    std::vector<ObjectId> all;
    for (ObjectId id = 0; id < scene_.objectLimit(); ++id) {
      if (scene_.hasObject(id)) all.push_back(id);
    }
    return all;
  }
  Transform movedPose(ObjectId id) { return moved(scene_.object(id).worldFromMesh, size(), random_); }

  void editOnce() {
    switch (random_.below(9)) {
      case 0:
        return moveMany();
      case 1:
        return deform();
      case 2:
        return addObject();
      case 3:
        return removeObject();
      case 4:
        return addMesh();
      case 5:
        return removeMesh();
      case 6:
        return setMotion();
      case 7:
        return fuzz::requireRefused([&] { scene_.setTransform(scene_.objectLimit(), {}); });
      default:
        return moveOne();
    }
  }

  void moveOne() {
    const ObjectId id = anyObject();
    const bool copies = random_.oneIn(3);  // copies lie on each other
    scene_.setTransform(id, copies ? scene_.object(anyObject()).worldFromMesh : movedPose(id));
  }

  void moveMany() {
    std::vector<ObjectId> ids = allObjects();
    std::erase_if(ids, [&](ObjectId) { return random_.oneIn(3); });
    std::vector<Transform> poses;
    for (const ObjectId id : ids) poses.push_back(movedPose(id));
    scene_.setTransforms(ids, poses);
  }

  void deform() {
    const MeshId id = anyMesh();
    std::vector<float> positions(scene_.mesh(id).positions.begin(), scene_.mesh(id).positions.end());
    const auto factor = static_cast<float>(random_.oneIn(2) ? random_.uniform(0.7, 1.4) : 1);
    for (float& x : positions) {
      const float to = random_.oneIn(8) ? x * static_cast<float>(random_.uniform(0.9, 1.1)) : x * factor;
      if (std::abs(to) < 1e30f) x = to;
    }
    scene_.setPositions(id, positions);
  }

  void addObject() {
    if (scene_.objectLimit() > 200) return;
    Object object = scene_.object(anyObject());
    object.worldFromMesh = moved(object.worldFromMesh, size(), random_);
    if (random_.oneIn(4)) object.mesh = anyMesh();
    if (random_.oneIn(4)) object.mask = 1u << random_.below(32);
    if (validate(object.worldFromMesh).empty()) scene_.addObject(object);
  }

  void removeObject() {
    const ObjectId gone = anyObject();
    if (allObjects().size() > 1) scene_.removeObject(gone);
  }

  void addMesh() {
    if (scene_.meshLimit() > ownMeshes_ + 20) return;
    const tools::MeshData mesh = random_.oneIn(2) ? tools::anyShape(random_) : tools::latticeShape(random_);
    Object object = scene_.object(anyObject());
    object.mesh = scene_.addMesh(mesh.positions, mesh.indices);
    scene_.addObject(object);
  }

  /// One that was added, with its objects.
  void removeMesh() {
    const MeshId gone = anyMesh();
    if (gone < ownMeshes_) return;
    std::vector<ObjectId> all = allObjects();
    const size_t before = all.size();
    std::erase_if(all, [&](ObjectId id) { return scene_.object(id).mesh != gone; });
    if (all.size() == before) return;
    for (const ObjectId id : all) scene_.removeObject(id);
    scene_.removeMesh(gone);
  }

  void setMotion() {
    if (!isMoving_) return;
    const ObjectId id = anyObject();
    scene_.setMotion(id, random_.oneIn(3) ? tools::Vec3{} : random_.magnitude(-6, 1) * size() * random_.direction());
    scene_.setBounds(id, {{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}});  // concern only hosts that move it
  }

  Random& random_;
  Source source_;
  Scene scene_;
  bool isMoving_ = false;
  uint32_t ownMeshes_ = 0;
  std::vector<Query> asked_;
  std::vector<double> sizes_;  ///< of their sensors
};

}  // namespace

std::unique_ptr<World> makeHardWorld(tools::Random& random) {
  return std::make_unique<HardWorld>(random);
}

}  // namespace radar::soak
