#include <algorithm>
#include <cmath>

#include "fuzz/target.h"
#include "soak/model.h"
#include "soak/vary.h"
#include "soak/world.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"
#include "workloads/interlocking.h"
#include "workloads/random_shapes.h"

namespace radar::soak {

namespace {

using tools::Random;
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

class HardWorld : public World {
 public:
  explicit HardWorld(Random& random) : random_(random), source_(source(random)) {
    const tools::Workload& workload = source_.workload;
    tools::replaceBy(workload, 0, scene_);
    isMoving_ = random_.oneIn(3);
    if (isMoving_) tools::setMotions(workload, random_, scene_);
    model_ = Model::of(scene_);
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
  Scene anew() const override { return model_.build(); }
  std::string name() const override { return source_.name; }

 private:
  template <class Items>
  auto any(Items& items) {
    return std::next(items.begin(), random_.below(static_cast<uint32_t>(items.size())));
  }
  double size() { return *any(sizes_); }

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
        return refuse();
      default:
        return moveOne();
    }
  }

  void moveOne() {
    auto& [id, object] = *any(model_.objects);
    object.worldFromMesh = random_.oneIn(3) ? any(model_.objects)->second.worldFromMesh  // copies lie on each other
                                            : moved(object.worldFromMesh, size(), random_);
    scene_.setTransform(id, object.worldFromMesh);
  }

  void moveMany() {
    std::vector<ObjectId> ids;
    std::vector<Transform> poses;
    for (auto& [id, object] : model_.objects) {
      if (random_.oneIn(3)) continue;
      object.worldFromMesh = moved(object.worldFromMesh, size(), random_);
      ids.push_back(id);
      poses.push_back(object.worldFromMesh);
    }
    scene_.setTransforms(ids, poses);
  }

  void deform() {
    auto& [id, mesh] = *any(model_.meshes);
    const auto factor = static_cast<float>(random_.oneIn(2) ? random_.uniform(0.7, 1.4) : 1);
    for (float& x : mesh.positions) {
      const float to = random_.oneIn(8) ? x * static_cast<float>(random_.uniform(0.9, 1.1)) : x * factor;
      if (std::abs(to) < 1e30f) x = to;
    }
    scene_.setPositions(id, mesh.positions);
  }

  void addObject() {
    if (model_.objects.size() > 200) return;
    Object object = any(model_.objects)->second;
    object.worldFromMesh = moved(object.worldFromMesh, size(), random_);
    if (random_.oneIn(4)) object.mesh = any(model_.meshes)->first;
    if (random_.oneIn(4)) object.mask = 1u << random_.below(32);
    if (validate(object.worldFromMesh).empty()) model_.objects[scene_.addObject(object)] = object;
  }

  void removeObject() {
    if (model_.objects.size() < 2) return;
    const auto gone = any(model_.objects);
    scene_.removeObject(gone->first);
    model_.objects.erase(gone);
  }

  void addMesh() {
    if (model_.meshes.size() > ownMeshes_ + 20) return;
    const tools::MeshData mesh = random_.oneIn(2) ? tools::anyShape(random_) : tools::latticeShape(random_);
    Object object = any(model_.objects)->second;
    object.mesh = scene_.addMesh(mesh.positions, mesh.indices);
    model_.meshes[object.mesh] = {mesh.positions, mesh.indices};
    model_.objects[scene_.addObject(object)] = object;
  }

  /// One that was added, with its objects.
  void removeMesh() {
    const auto gone = any(model_.meshes);
    if (gone->first < ownMeshes_) return;
    const auto uses = [&](const auto& item) { return item.second.mesh == gone->first; };
    if (std::ranges::all_of(model_.objects, uses)) return;
    for (const auto& item : model_.objects) {
      if (uses(item)) scene_.removeObject(item.first);
    }
    std::erase_if(model_.objects, uses);
    scene_.removeMesh(gone->first);
    model_.meshes.erase(gone);
  }

  void setMotion() {
    if (!isMoving_) return;
    auto& [id, object] = *any(model_.objects);
    object.motion = random_.oneIn(3) ? tools::Vec3{} : random_.magnitude(-6, 1) * size() * random_.direction();
    scene_.setMotion(id, object.motion);
    scene_.setBounds(id, {{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}});  // concern only hosts that move it
  }

  void refuse() {
    const uint64_t version = scene_.version();
    bool refused = false;
    try {
      scene_.setTransform(scene_.objectLimit(), {});
    } catch (const Error&) {
      refused = true;
    }
    fuzz::require(refused && scene_.version() == version, "setTransform of no object");
  }

  Random& random_;
  Source source_;
  Scene scene_;
  Model model_;
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
