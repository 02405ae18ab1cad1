// Objects that a host moves without bounds: the device fits the tree over objects to them, and answers equal those of
// a scene in which they are there.
#include "embed/moved_world.h"

#include <cmath>

#include "embed/on_device_scene.h"
#include "embed/written_queries.h"
#include "radar/cpu_sweeper.h"
#include "support/buffer_words.h"
#include "support/catch.h"

namespace {

using namespace radar;
using test::execute;
using test::kRoom;
using test::MovedWorld;
using test::sameBits;
using test::Scales;

const auto always = [](ObjectId) { return true; };
const auto never = [](ObjectId) { return false; };

/// What comparisons have found.
struct Found {
  size_t answers = 0, hits = 0, outOfRange = 0;
};

/// Answers that the device found have the bits of the CPU's; out of range are at most some.
void compare(std::span<const Result> got, const Scene& truth, const std::vector<Query>& queries, Found& found) {
  const std::vector<Result> expected = CpuSweeper(truth).run(queries).results;
  REQUIRE(got.size() == expected.size());
  for (size_t i = 0; i < got.size(); ++i) {
    Result wanted = expected[i];
    wanted.tier = got[i].tier;
    CAPTURE(i, got[i].flags, int(got[i].status), int(wanted.status), got[i].t, wanted.t, got[i].object, wanted.object);
    ++found.answers;
    found.hits += wanted.status == Status::hit;
    if (got[i].status == Status::invalid) {
      CHECK(got[i].flags == Flag::range);
      ++found.outOfRange;
    } else if (queries[i].anyHit) {
      CHECK(got[i].status == wanted.status);
      CHECK_FALSE(wanted.lo > got[i].hi);
    } else {
      CHECK(sameBits(got[i], wanted));
    }
  }
}

/// Compares answers to queries of both kinds over the world's geometry.
void compareBoth(Recorder& recorder, MovedWorld& world, Found& found) {
  std::vector<Query> queries = world.queries(kRoom.queries);
  for (Query& query : queries) query.exclude.resize(std::min<size_t>(query.exclude.size(), 1));
  compare(execute(recorder, queries, world.geometry()), world.truth, queries, found);
  std::vector<HostQuery> written;
  for (Query& query : queries) {
    written.push_back(test::hostQueryOf(query));
    query = test::queryOf(written.back());
  }
  compare(execute(recorder, written, world.geometry()), world.truth, queries, found);
}

/// The nodes of the tree over objects on the device, after the host's movement.
std::vector<gpu::ObjectNode> nodesOf(const MovedWorld& world) {
  const test::OnDeviceScene there(world.scene, world.geometry());
  return test::elementsOf(there.copy.buffers().objectNodes, 0, world.scene.impl().objectTree().nodes().size());
}

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
  MovedWorld world(objects, 11 + objects, scales, always, never);
  Recorder recorder(test::device(), world.scene, kRoom);
  Found found;
  for (int frame = 0; frame < 2; ++frame) {
    compareBoth(recorder, world, found);
    world.moveAgain();
  }
  CHECK(found.outOfRange == 0);
  CHECK(found.hits > found.answers / 20);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE(
    "among thousands of objects, those that a host moves, with bounds and without, and those that stand are found") {
  const Scales scales{1, 40, 100};
  MovedWorld world(
      4000, 5, scales, [](ObjectId id) { return id % 3 != 0; }, [](ObjectId id) { return id % 50 == 1; });
  Recorder recorder(test::device(), world.scene, kRoom);
  Found found;
  for (int frame = 0; frame < 3; ++frame) {
    compareBoth(recorder, world, found);
    world.moveAgain();
  }
  CHECK(found.outOfRange == 0);
  CHECK(found.hits > found.answers / 3);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an object that takes another's number between two recordings is moved with its own mesh and mask") {
  MovedWorld world(24, 31, {1, 8, 0}, always, never);
  Recorder recorder(test::device(), world.scene, kRoom);
  Found found;
  for (int frame = 0; frame < 6; ++frame) {
    CAPTURE(frame);
    for (const ObjectId id : {ObjectId{3}, ObjectId{17}, ObjectId{23}}) {
      Object other = world.scene.object(id);
      other.mesh = world.meshes[(other.mesh + 4) % 9];
      other.mask ^= 1;
      for (Scene* scene : {&world.scene, &world.truth}) {
        scene->removeObject(id);
        REQUIRE(scene->addObject(other) == id);
      }
    }
    world.moveAgain();
    compareBoth(recorder, world, found);
  }
  CHECK(found.outOfRange == 0);
  CHECK(found.hits > found.answers / 10);
  CHECK(test::takeValidationMessages().empty());
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
  const std::vector<gpu::ObjectNode> nodes = nodesOf(world);
  const ObjectTree& tree = world.scene.impl().objectTree();
  REQUIRE(tree.inRange());
  size_t outside = 0;
  Real tightest = 1e30L;
  for (ObjectId id = 0; id < world.truth.objectLimit(); ++id) {
    const Object& object = world.truth.object(id);
    const gpu::ObjectNode& leaf = nodes[tree.leafOf(id)];
    const MeshView mesh = world.truth.mesh(object.mesh);
    for (size_t v = 0; v < mesh.positions.size() / 3; ++v) {
      const std::array<double, 3> placed = transformPoint(object.worldFromMesh, &mesh.positions[3 * v]);
      std::array<Real, 3> p;
      for (size_t k = 0; k < 3; ++k) p[k] = Real(placed[k]) - Real(tree.anchor()[k]);
      for (uint32_t n = tree.leafOf(id); n != kNone; n = tree.parentOf(n)) outside += contains(nodes[n], p) ? 0 : 1;
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
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE("an object that a recording no longer moves is where the scene has it, whichever moved before") {
  const Scales scales{1, 12, 200};
  MovedWorld world(130, 8, scales, always, never);
  std::vector<ObjectId> all = world.moved, odd, few{5, 77};
  for (ObjectId id = 1; id < 130; id += 2) odd.push_back(id);
  SceneCopy copy(test::device(), world.scene);
  Recorder first(copy, kRoom), second(copy, kRoom);
  Scene mixed;
  const std::vector<MeshId> meshes = test::addSmallMeshes(mixed, 8);
  for (const ObjectId id : all) mixed.addObject(world.scene.object(id));
  Found found;
  const std::vector<Query> near = world.queries(24);
  int frame = 0;
  for (const std::vector<ObjectId>& moved : {all, {}, odd, few, {}, odd, few, all, few, {}}) {
    CAPTURE(frame);
    for (const ObjectId id : all) mixed.setTransform(id, world.scene.object(id).worldFromMesh);
    for (const ObjectId id : moved) mixed.setTransform(id, world.truth.object(id).worldFromMesh);
    world.moved = moved;
    if (!moved.empty()) world.show();
    const HostGeometry geometry = moved.empty() ? HostGeometry{} : world.geometry();
    std::vector<Query> queries = near;
    for (size_t i = 0; i < 24; ++i) {
      // Half of them among the objects as the scene has them.
      Query query = near[i];
      for (size_t k = 0; k < 3; ++k) query.worldFromMesh.m[4 * k + 3] = 3.0 * static_cast<double>(i % 5) - 6;
      queries.push_back(query);
    }
    Recorder& recorder = frame % 3 == 1 ? second : first;
    compare(execute(recorder, queries, geometry), mixed, queries, found);
    if (frame == 4) {
      // Neither of these is executed. `first` moves the same next time.
      world.moved = odd;
      world.show();
      gpu::Submission submission(test::device().impl(), false);
      first.record(submission.begin(), queries, world.geometry());
      first.reset();
      second.record(submission.begin(), queries);
      second.reset();
    }
    ++frame;
  }
  CHECK(found.outOfRange == 0);
  CHECK(found.hits > found.answers / 5);
  CHECK(test::takeValidationMessages().empty());
}

TEST_CASE(
    "objects that are added, removed or given bounds between recordings are found, beside those that a host moves") {
  MovedWorld world(40, 21, {1, 10, 90}, always, never);
  Recorder recorder(test::device(), world.scene, kRoom);
  Found found;
  for (int frame = 0; frame < 8; ++frame) {
    CAPTURE(frame);
    if (frame % 4 == 1) {
      const ObjectId gone = world.moved[3];
      world.scene.removeObject(gone);
      world.truth.removeObject(gone);
      std::erase(world.moved, gone);
      // Another takes its number, and stands.
      const Object object{world.meshes[0], test::floatPose(world.random, 1, {5, 5, 5}), 3};
      CHECK(world.scene.addObject(object) == world.truth.addObject(object));
    } else if (frame % 4 == 2) {
      world.scene.setBounds(world.moved[7], {{-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}});
    } else if (frame % 4 == 3) {
      const Object object{world.meshes[4], test::floatPose(world.random, 1, {-3, 2, 5}), 3};
      world.moved.push_back(world.scene.addObject(object));
      CHECK(world.truth.addObject(object) == world.moved.back());
    }
    world.moveAgain();
    compareBoth(recorder, world, found);
  }
  CHECK(found.outOfRange == 0);
  CHECK(found.hits > found.answers / 10);
  CHECK(test::takeValidationMessages().empty());
}
