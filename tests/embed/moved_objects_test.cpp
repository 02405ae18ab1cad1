// Objects that a host moves without bounds: the device fits the tree over objects to them, and answers equal those of
// a scene in which they are there.
#include <cmath>

#include "embed/host_world.h"
#include "embed/object_nodes.h"
#include "embed/on_device_scene.h"
#include "support/catch.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using namespace test;

/// Every answer is given, and not less than one in so many is a hit.
void checkAllAnswered(const fuzz::Outcomes& outcomes, size_t oneIn) {
  CHECK(outcomes.areExact());
  CHECK(outcomes.hits > outcomes.answered / oneIn);
}

/// Asks queries of both kinds in each frame, between which `change` and all moved objects change the world.
template <class Change>
fuzz::Outcomes outcomesOf(MovedWorld& world, int frames, const Change& change) {
  Recorder recorder(test::device(), world.scene, kRoom);
  fuzz::Outcomes outcomes;
  for (int frame = 0; frame < frames; ++frame) {
    CAPTURE(frame);
    const test::Written written(world.queries(kRoom.queries));
    ask(recorder, written.same, world, outcomes);
    ask(recorder, written, world, outcomes);
    change(frame);
    world.moveAgain();
  }
  return outcomes;
}
const auto nothing = [](int) {};

using Real = long double;

/// Whether a node's box contains a coordinate on every axis.
bool contains(const gpu::ObjectNode& node, const std::array<Real, 3>& p) {
  bool inside = true;
  for (size_t k = 0; k < 3; ++k) inside = inside && std::abs(p[k] - Real(node.centre[k])) <= Real(node.halfExtent[k]);
  return inside;
}

}  // namespace

TEST_CASE(
    "objects that a host moves without bounds are found where they are, with the bits of a scene that has them there",
    "[subgroups]") {
  const Scales scales = GENERATE(values<Scales>({{1, 8, 0},
                                                 {1, 8, 300},
                                                 {1, 60, 0x1p16},
                                                 {1, 20, 0x1p20, 0x1p20},
                                                 {0x1p-20, 0x1p-16, 0x1p-10},
                                                 {0x1p30, 0x1p34, 0x1p40},
                                                 {1, 0x1p14, 0x1p18}}));
  const uint32_t objects = GENERATE(1u, 2u, 3u, 60u);
  CAPTURE(scales.size, scales.spread, scales.away, objects);
  MovedWorld world(objects, 11 + objects, scales);
  checkAllAnswered(outcomesOf(world, 2, nothing), 20);
}

TEST_CASE(
    "among thousands of objects, those that a host moves, with bounds and without, and those that stand are found") {
  MovedWorld world(
      4000, 5, {1, 40, 100}, [](ObjectId id) { return id % 3 != 0; }, [](ObjectId id) { return id % 50 == 1; });
  checkAllAnswered(outcomesOf(world, 3, nothing), 3);
}

TEST_CASE("through many frames, in which objects move far, gather, stand, and are out of bounds, answers stay exact") {
  MovedWorld world(700, 9, {1, 30, 40}, [](ObjectId id) { return id % 4 != 1; });
  constexpr uint32_t kQueries =
      8;  // so few that most recordings keep the parts of the tree over objects in their order
  Recorder recorder(test::device(), world.scene, kRoom);
  fuzz::Outcomes outcomes;
  for (int frame = 0; frame < 40; ++frame) {
    CAPTURE(frame);
    const std::vector<Query> queries = world.queries(kQueries);
    ask(recorder, queries, world, outcomes);
    if (frame % 8 == 7) {
      Transform nowhere;
      nowhere.m[3] = frame % 16 == 7 ? NAN : 1e25;
      const std::vector<Result> read =
          test::execute(recorder, queries, test::HostFrame().move(world.moved[frame], nowhere).geometry());
      for (const Result& result : read) CHECK(result.flags == Flag::bounds);
    }
    if (frame % 4 == 1) {
      for (const ObjectId id : world.moved) {
        Transform pose = world.truth.object(id).worldFromMesh;
        for (const size_t k : {3, 7, 11}) pose.m[k] = frame % 8 == 1 ? 5 : 0x1p14 * pose.m[k];
        if (id % (frame % 8 == 1 ? 16 : 3) == 0) world.truth.setTransform(id, pose);
      }
    } else if (frame % 4 != 2) {
      world.moveAgain();
    }
  }
  CHECK(outcomes.areExact());
  CHECK(outcomes.answered == 40 * kQueries);
}

TEST_CASE("a host names moved objects by range, in each recording another one") {
  Scene scene;
  const MeshId mesh = test::addBox(scene);
  for (int i = 0; i < 4; ++i) scene.addObject({.mesh = mesh, .worldFromMesh = test::at(10 * i, 50, 0)});
  const float places[] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 7, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 9};
  const auto bytes = std::as_bytes(std::span(places));
  const test::OnDevice buffer({bytes.begin(), bytes.end()});
  Recorder recorder(test::device(), scene);
  const Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 20};
  for (const ObjectId first : {0u, 2u, 1u}) {
    const MovedObjects moved{.transforms = buffer.get(), .firstObject = first, .count = 2};
    const Result nearest = test::execute(recorder, std::vector{query}, {.objects = {&moved, 1}}).at(0);
    CHECK(nearest.object == first);
    CHECK(nearest.t == 6);
  }
}

TEST_CASE("an object that takes another's number between two recordings is moved with its own mesh and mask") {
  MovedWorld world(24, 31, {1, 8, 0});
  const auto exchange = [&](int) {
    for (const ObjectId id : {3, 17, 23}) {
      Object other = world.scene.object(id);
      other.mesh = world.meshes[(other.mesh + 4) % 9];
      other.mask ^= 1;
      for (Scene* scene : {&world.scene, &world.truth}) {
        scene->removeObject(id);
        REQUIRE(scene->addObject(other) == id);
      }
    }
  };
  checkAllAnswered(outcomesOf(world, 7, exchange), 10);
}

TEST_CASE("the device's tree over objects contains every object where the host puts it, at any scale and place") {
  const Scales scales = GENERATE(values<Scales>({{1, 8, 0},
                                                 {1, 8, 0x1p20},
                                                 {1, 8, 0x1p20, 0x1p20},
                                                 {0x1p-8, 8, 0x1p20, 0x1p28},
                                                 {0x1p-10, 0x1p10, 0x1p14},
                                                 {0x1p-60, 0x1p-58, 0x1p-40},
                                                 {0x1p60, 0x1p62, 0x1p70},
                                                 {0x1p-76, 0x1p-120, 0}}));
  CAPTURE(scales.size, scales.spread, scales.away);
  MovedWorld world(
      700, 3, scales, [](ObjectId id) { return id % 4 != 0; }, never);
  const test::ObjectNodes nodes = test::OnDeviceScene(world.scene, world.geometry()).objectNodes();
  const auto paths = test::pathsTo(nodes);
  const ObjectTree& tree = world.scene.impl().objectTree();
  REQUIRE(tree.inRange());
  size_t outside = 0;
  Real tightest = 1e30L;
  for (ObjectId id = 0; id < world.truth.objectLimit(); ++id) {
    const Object& object = world.truth.object(id);
    const std::vector<uint32_t>& path = paths.at(id);
    const gpu::ObjectNode& leaf = nodes[path.back()];
    const MeshView mesh = world.truth.mesh(object.mesh);
    for (size_t v = 0; v < mesh.positions.size() / 3; ++v) {
      const std::array<double, 3> placed = transformPoint(object.worldFromMesh, &mesh.positions[3 * v]);
      std::array<Real, 3> p;
      for (size_t k = 0; k < 3; ++k) p[k] = Real(placed[k]) - Real(tree.anchor()[k]);
      for (const uint32_t n : path) outside += contains(nodes[n], p) ? 0 : 1;
    }
    // No larger than needed: the box of the object's box, and its rounding.
    const Box box = boxOf(world.truth.impl().meshes[object.mesh], object.worldFromMesh.m);
    for (int k = 0; k < 3; ++k) {
      const Real needed = 0.5L * (Real(box.hi[k]) - Real(box.lo[k])) + std::abs(Real(leaf.centre[k])) * 1.5e-6L +
                          1e-5L * (std::abs(Real(tree.anchor()[k])) * 1e-6L + 400 * scales.size);
      tightest = std::min(tightest, needed * 1.001L - Real(leaf.halfExtent[k]));
    }
  }
  CHECK(outside == 0);
  if (test::device().doubles()) CHECK(tightest >= 0);
}

TEST_CASE("an object that a recording no longer moves is where the scene has it, whichever moved before") {
  MovedWorld world(130, 8, {1, 12, 200});
  const std::vector<ObjectId> all = world.moved, few{5, 77};
  std::vector<ObjectId> odd = all;
  std::erase_if(odd, [](ObjectId id) { return id % 2 == 0; });
  std::vector<Transform> there;
  for (const ObjectId id : all) there.push_back(world.truth.object(id).worldFromMesh);
  SceneCopy copy(test::device(), world.scene);
  Recorder first(copy, kRoom), second(copy, kRoom);
  std::vector<Query> queries = world.queries(48);
  // Half of them among the objects as the scene has them.
  for (size_t i = 24; i < 48; ++i) {
    for (size_t k = 0; k < 3; ++k) queries[i].worldFromMesh.m[4 * k + 3] = 3.0 * static_cast<double>(i % 5) - 6;
  }
  fuzz::Outcomes outcomes;
  int frame = 0;
  for (const std::vector<ObjectId>& moved : {all, {}, odd, few, {}, odd, few, all, few, {}}) {
    CAPTURE(frame);
    for (const ObjectId id : all) world.truth.setTransform(id, world.scene.object(id).worldFromMesh);
    for (const ObjectId id : moved) world.truth.setTransform(id, there[id]);
    world.moved = moved;
    Recorder& recorder = frame % 3 == 1 ? second : first;
    ask(recorder, queries, world, outcomes);
    if (frame++ != 4) continue;
    // Neither of these is executed. `first` moves the same next time.
    world.moved = odd;
    gpu::Submission submission(test::device().impl(), false);
    first.record(submission.begin(), queries, world.geometry());
    first.reset();
    second.record(submission.begin(), queries);
    second.reset();
  }
  checkAllAnswered(outcomes, 5);
}

TEST_CASE(
    "objects that are added, removed or given bounds between recordings are found, beside those that a host moves") {
  MovedWorld world(40, 21, {1, 10, 90});
  const auto change = [&](int frame) {
    if (frame % 4 == 0) {
      // Another takes its number, and stands.
      world.remove(world.moved[3]);
      world.add({world.meshes[0], test::floatPose(world.random, 1, {5, 5, 5}), 3});
    } else if (frame % 4 == 1) {
      world.scene.setBounds(world.moved[7], {{-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}});
    } else if (frame % 4 == 2) {
      world.moved.push_back(world.add({world.meshes[4], test::floatPose(world.random, 1, {-3, 2, 5}), 3}));
    }
  };
  checkAllAnswered(outcomesOf(world, 8, change), 10);
}
