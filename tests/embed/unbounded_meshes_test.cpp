// Searches of what a host deforms without bounds: with every option of a query, in turns with other geometry, and what
// is refused.
#include <cmath>

#include "embed/checks.h"
#include "embed/host_world.h"
#include "embed/renderer.h"
#include "radar/host.h"
#include "support/small_scenes.h"

namespace {

using namespace radar;
using test::at;
using test::kRoom;

}  // namespace

TEST_CASE("lists, steps, clearances and contacts at rest are those of the vertices that a host deforms without bounds",
          "[subgroups]") {
  test::HostWorld world;
  Recorder recorder(
      test::device(), world.scene,
      {.queries = 24, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 18, .searches = 1u << 14});
  tools::Random random(6);
  fuzz::Outcomes all;
  uint32_t seed = 400;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    CAPTURE(family.name, ++seed);
    const tools::Workload workload = tools::hardScene(family, seed, 0, 24, tools::Company::mixed);
    tools::replaceBy(workload, 0, world.truth);
    const bool moves = seed % 3 == 0;
    if (moves) tools::setMotions(workload, random, world.truth);
    test::hide(world, seed, false);
    std::vector<Query> queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); ++i) {
      queries[i].anyHit = i % 7 == 2;
      const bool isPlain = !moves && i % 4 != 0;
      if (!isPlain) tools::takeStep(queries[i]);
      if (i % 3 == 0 && !queries[i].anyHit) queries[i].hits = i % 2 == 0 ? kAllHits : 2;
      if (isPlain && i % 3 != 0 && !queries[i].ignoreLeaving && !queries[i].anyHit) {
        queries[i].clearance = std::exp2(random.uniform(-10, -2));
        if (random.oneIn(2)) queries[i].tolerance = std::exp2(random.uniform(-20, -4));
      }
    }
    ask(recorder, queries, world, all);
  }
  CHECK(all.answered > 500);
  CHECK(all.hits > all.answered / 5);
  CHECK(all.listed > 300);
  // Without a tree for the deformed mesh, or as a clearance that doubles leave open.
  CHECK(all.lacking() < all.answered / 20);
  CHECK(all.outOfRange == 0);
}

TEST_CASE("meshes that a recording no longer deforms, and their objects, are the scene's again") {
  // Which meshes are deformed, and how, and which objects are moved, changes from frame to frame.
  test::MovedWorld world(60, 12, {1, 10, 0});
  const std::vector<ObjectId> all = world.moved;
  SceneCopy copy(test::device(), world.scene);
  Recorder first(copy, kRoom), second(copy, kRoom);
  fuzz::Outcomes outcomes;
  for (int frame = 0; frame < 12; ++frame) {
    CAPTURE(frame);
    world.deformAgain();
    world.moved.clear();
    for (const ObjectId id : all) {
      world.truth.setTransform(id, world.scene.object(id).worldFromMesh);
      if (frame % 3 != 0 && world.random.oneIn(3)) world.moved.push_back(id);
    }
    world.moveAgain();
    const std::vector<Query> queries = world.queries(40);
    Recorder& recorder = frame % 2 == 0 ? first : second;
    ask(recorder, queries, world, outcomes);
    if (frame != 7) continue;
    // Not executed.
    gpu::Submission submission(test::device().impl(), false);
    first.record(submission.begin(), queries, world.geometry());
    first.reset();
  }
  CHECK(outcomes.hits > 100);
  CHECK(outcomes.areExact());
}

TEST_CASE("of a mesh in a shared buffer the vertices of its triangles are read, and must be finite and within bounds") {
  const bool isBounded = GENERATE(false, true);
  Scene scene;
  const float nan = NAN;
  // Vertices of the host's buffer that are a triangle; bounds hold for those between them, too.
  const std::array<uint16_t, 3> used = isBounded ? std::array<uint16_t, 3>{5, 6, 7} : std::array<uint16_t, 3>{2, 4, 7};
  const auto positions = [&](float z, float other, float last) {
    std::vector<float> all(24, other);
    const float corners[] = {-1, -1, z, 1, -1, z, 0, 1, last};
    for (size_t i = 0; i < 9; ++i) all[3 * size_t{used[i / 3]} + i % 3] = corners[i];
    return all;
  };
  std::vector<std::byte> corners;
  test::append<uint16_t>(corners, {used[1], used[0], used[2]});
  const test::OnDevice rest = test::bufferOf(positions(5, 1000, 5)), indices(corners);
  HostMesh shared{.positions = {.buffer = rest.get()},
                  .vertexCount = 8,
                  .indices = indices.get(),
                  .indexType = VK_INDEX_TYPE_UINT16,
                  .indexCount = 3};
  if (isBounded) shared.bounds = Bounds{{-1, -1, 0}, {1, 1, 10}};
  const MeshId wall = addMesh(scene, test::device(), shared);
  scene.addObject({.mesh = wall});
  // Of this one, vertex 3 belongs to no triangle.
  const float quad[] = {-1, -1, 0, 1, -1, 0, 0, 1, 0, 7, 7, 7};
  const MeshId own = scene.addMesh(quad, test::triangle().indices);
  scene.addObject({.mesh = own, .worldFromMesh = at(40, 0, 6)});
  std::vector<Query> queries(2, {.mesh = test::addBox(scene), .direction = {0, 0.001, 1}, .distance = 20});
  queries[1].worldFromMesh = at(40, 0, 0);
  Recorder recorder(test::device(), scene, kRoom);
  const auto check = [&](const std::vector<float>& first, float z, float unused, const std::string& violation) {
    CAPTURE(violation);
    const std::vector<float> second{-1, -1, z, 1, -1, z, 0, 1, z, unused, unused, unused};
    test::HostFrame frame;
    const std::vector<Result> read =
        test::execute(recorder, queries, frame.deform(wall, first).deform(own, second).geometry());
    CHECK(recorder.boundsViolation() == violation);
    if (violation.empty()) {
      CHECK(read[0].t == Approx(2.5));
      CHECK(read[1].t == Approx(6.5));
    } else {
      for (const Result& result : read) CHECK(test::isRefused(result, Flag::bounds));
    }
  };
  const std::string vertex7 = isBounded ? "mesh 0: vertex 7 is outside its bounds or not finite"
                                        : "mesh 0: vertex 7 is not finite, or exceeds 2^120";
  check(positions(3, 0, 3), 1, 0, "");
  check(positions(3, nan, 3), 1, 1e35f, "");
  check(positions(3, 0, nan), 1, 0, vertex7);
  check(positions(3, 0, 3), 1, nan, "mesh 1: vertex 3 is not finite, or exceeds 2^120");
  check(positions(3, 0, -3e38f), 1, 0, vertex7);
  check(positions(3, 0, 3), 1, 0, "");
  if (isBounded) return check(positions(3, 0, 11), 1, 0, vertex7);
  // Too large to be placed: the object leaves what floats can hold.
  check(positions(1e30f, 0, 1e30f), 1, 0, "object 0: its transform is not finite, or floats cannot hold its box");
}
