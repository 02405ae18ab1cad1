// The tree over objects, built on the device above what a host moves and what stands.
#include <cmath>

#include "embed/host_world.h"
#include "embed/object_nodes.h"
#include "embed/on_device_scene.h"
#include "support/catch.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using namespace test;

constexpr uint32_t kMany = 1u << 20;  // searches, for which it pays to sort anything

/// Boxes in a region, some of which walk to goals, which change; the others stand.
struct Crowd {
  Crowd(uint32_t walking, uint32_t standing, const tools::Vec3& half) : region(half) {
    const MeshId mesh = test::addBox(scene), building = test::addMesh(scene, tools::makeBox({2, 3, 5}));
    for (uint32_t i = 0; i < walking + standing; ++i) {
      const bool walks = i < walking;
      const tools::Vec3 at = place();
      scene.addObject({.mesh = walks ? mesh : building, .worldFromMesh = test::at(at[0], at[1], at[2])});
      if (!walks) continue;
      places.push_back(at);
      goals.push_back(place());
    }
  }
  tools::Vec3 place() { return random.inBox({-region[0], -region[1], -region[2]}, region); }
  void walk(double stride) {
    for (size_t i = 0; i < places.size(); ++i) {
      double length = 0;
      for (size_t k = 0; k < 3; ++k) length += std::pow(goals[i][k] - places[i][k], 2);
      length = std::sqrt(length);
      if (length < stride || random.oneIn(100)) goals[i] = place();
      for (size_t k = 0; k < 3; ++k) places[i][k] += stride * (goals[i][k] - places[i][k]) / std::max(length, stride);
    }
  }
  void scatter() {
    for (tools::Vec3& at : places) at = place();
  }
  void record(uint32_t searches) {
    frame = test::HostFrame();
    for (ObjectId id = 0; id < places.size(); ++id) {
      frame.move(id, test::at(places[id][0], places[id][1], places[id][2]));
    }
    there.move(frame.geometry(), searches);
  }

  Scene scene;
  tools::Vec3 region;
  tools::Random random{8};
  std::vector<tools::Vec3> places, goals;
  test::HostFrame frame;
  OnDeviceScene there{scene};
};

}  // namespace

TEST_CASE("however often a host moves objects, the tree that the device builds is as good as one that the CPU builds") {
  struct Region {
    tools::Vec3 half;
    uint32_t standing;
  };
  const Region region = GENERATE(Region{{20, 20, 20}, 0}, Region{{80, 80, 1}, 0}, Region{{30, 30, 30}, 4000});
  CAPTURE(region.half, region.standing);
  Crowd crowd(1500, region.standing, region.half);
  crowd.record(kMany);
  const ObjectNodes first = crowd.there.objectNodes();
  for (int frame = 0; frame < 60; ++frame) {
    crowd.walk(0.5);
    crowd.record(kMany);
  }
  const ObjectNodes last = crowd.there.objectNodes();
  REQUIRE(faultOf(last, crowd.scene) == "");
  const double fresh = static_cast<double>(testsOf(test::rebuilt(last), 12));
  CAPTURE(fresh);
  CHECK(static_cast<double>(testsOf(last, 12)) < 1.3 * fresh);
  // With the links of the first frame it would not be.
  CHECK(static_cast<double>(testsOf(test::refitted(last, first), 12)) > 1.4 * fresh);
}

TEST_CASE("a recording that searches little keeps the order of the parts, but no more than sixteen do") {
  Crowd crowd(2000, 0, {20, 20, 20});
  crowd.record(0);
  crowd.scatter();
  int kept = 0;
  const auto isGood = [&] {
    crowd.record(0);
    const ObjectNodes nodes = crowd.there.objectNodes();
    REQUIRE(faultOf(nodes, crowd.scene) == "");
    return testsOf(nodes, 12) < 2 * testsOf(test::rebuilt(nodes), 12);
  };
  while (kept < 20 && !isGood()) ++kept;
  CHECK(kept == 15);
  // Searches pay for themselves.
  crowd.scatter();
  crowd.record(500);
  const ObjectNodes nodes = crowd.there.objectNodes();
  CHECK(testsOf(nodes, 12) < 2 * testsOf(test::rebuilt(nodes), 12));
}

TEST_CASE("the tree that the device builds has each object once, and each box all that are below it") {
  const uint32_t objects = GENERATE(1u, 2u, 3u, 4u, 7u, 8u, 9u, 63u, 64u, 65u, 513u, 1234u);
  const bool isPart = GENERATE(false, true);
  CAPTURE(objects, isPart);
  test::MovedWorld world(
      objects, 17 + objects, {1, 20, 50}, [&](ObjectId id) { return !isPart || id % 5 == 1 || id + 1 == objects; },
      [&](ObjectId id) { return isPart && id % 7 == 2; });
  OnDeviceScene there(world.scene);
  for (const uint32_t searches : {0u, kMany, 0u, 0u, kMany}) {
    CAPTURE(searches);
    there.move(world.geometry(), searches);
    REQUIRE(faultOf(there.objectNodes(), world.scene) == "");
    world.moveAgain();
  }
}

TEST_CASE("a tree is built above objects in one place, on a line, and far apart") {
  const double spread = GENERATE(0.0, 0x1p-70, 0x1p-20, 1.0, 0x1p20, 0x1p76);
  const size_t axes = GENERATE(1u, 3u);
  CAPTURE(spread, axes);
  Crowd crowd(300, 40, {20, 20, 20});
  for (size_t i = 0; i < crowd.places.size(); ++i) {
    tools::Vec3& at = crowd.places[i];
    at = {};
    // Each half as far away as another.
    for (size_t k = 0; k < axes; ++k) at[k] = spread * std::exp2(-static_cast<double>((i + 7 * k) % 60));
  }
  crowd.record(kMany);
  CHECK(faultOf(crowd.there.objectNodes(), crowd.scene) == "");
}

TEST_CASE("an object that a host moves takes as much memory as docs/embedding.md says") {
  constexpr uint32_t kObjects = 10'000;
  Crowd crowd(kObjects, 0, {100, 100, 100});
  Recorder recorder(test::device(), crowd.scene);
  const std::vector<Query> none;
  recorder.prepare(none);
  const uint64_t before = recorder.memoryUse();
  const test::OnDevice transforms(std::vector<std::byte>(48 * kObjects));
  const MovedObjects all{.transforms = transforms.get(), .count = kObjects};
  recorder.prepare(none, {.objects = {&all, 1}});
  CHECK(recorder.memoryUse() - before <= 400 * kObjects);
}

TEST_CASE("a link or a box of the tree over objects that is wrong is noticed") {
  Crowd crowd(200, 100, {20, 20, 20});
  crowd.record(kMany);
  const ObjectNodes nodes = crowd.there.objectNodes();
  REQUIRE(faultOf(nodes, crowd.scene) == "");
  tools::Random random(3);
  const auto paths = test::pathsTo(nodes);
  for (int i = 0; i < 200; ++i) {
    const std::vector<uint32_t>& path = paths.at(random.below(300));
    const uint32_t n = path[random.below(static_cast<uint32_t>(path.size()))];
    CAPTURE(i, n);
    ObjectNodes wrong = nodes;
    wrong[n].link = nodes[n].link ^ (1 + random.below(3));
    CHECK(faultOf(wrong, crowd.scene) != "");
    // The device has fitted the boxes above those of parts.
    if ((nodes[n].link & gpu::kLinkLeaf) != 0 || nodes[n].link < crowd.scene.impl().objectTree().nodes().size())
      continue;
    wrong = nodes;
    wrong[n].halfExtent[random.below(3)] *= 0.99f;
    CHECK(faultOf(wrong, crowd.scene) != "");
  }
}
