// Capacities of a recording: a query that exceeds one is invalid or unresolved and has its flag; no answer is wrong.
#include <cmath>
#include <numeric>

#include "embed/checks.h"
#include "embed/on_device.h"
#include "embed/renderer.h"
#include "fuzz/check_recorded.h"
#include "support/small_scenes.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace {

using namespace radar;
using test::at;
using test::execute;

/// Queries of a scene, and the CPU's answers.
struct Batch {
  Batch(Scene from, std::vector<Query> asked)
      : scene(std::move(from)), queries(std::move(asked)), truth(CpuSweeper(scene).run(queries)) {}
  explicit Batch(test::Case asked) : Batch(std::move(asked.scene), std::move(asked.queries)) {}

  /// Of a recording; no answer may be wrong.
  fuzz::Outcomes outcomes(const Capacity& capacity, const Device& device = test::device()) const {
    Recorder recorder(device, scene, capacity);
    fuzz::Outcomes outcomes;
    fuzz::checkRecorded(queries, execute(device, recorder, queries), truth, outcomes);
    CHECK(outcomes.outOfRange + outcomes.reordered == 0);
    // read() decides what is unresolved, and no other answer.
    const AnswerCounts counted = recorder.answerCounts();
    CHECK(counted.isExecuted);
    CHECK(std::accumulate(counted.byStatus.begin(), counted.byStatus.end(), 0u) == queries.size());
    CHECK(counted.flagged(Flag::candidates) == outcomes.candidates);
    CHECK(counted.flagged(Flag::rounds) == outcomes.rounds);
    CHECK(counted.flagged(Flag::unresolved) >= outcomes.unresolved);
    CHECK(counted.of(Status::undecided) <= counted.flagged(Flag::unresolved));  // hits are open, too
    CHECK(counted.of(Status::hit) + counted.of(Status::clear) + counted.of(Status::overlap) +
              counted.of(Status::undecided) ==
          outcomes.answered + outcomes.unresolved);
    return outcomes;
  }
  Scene scene;
  std::vector<Query> queries;
  Answers truth;
};

Batch hardBatch(const char* family) {
  tools::Workload workload = tools::hardScene(tools::hardFamily(family), 6, 0, 48, tools::Company::mixed);
  for (size_t i = 0; i < workload.queries.size(); i += 5) workload.queries[i].anyHit = true;
  return Batch(test::caseOf(workload));
}

/// A teapot inside a sphere that is hardly larger, so that very many node pairs overlap; and beside it a cheap query
/// that hits a box.
Batch heavyAndLight() {
  Scene scene;
  const MeshId pot = test::addMesh(scene, tools::makeTeapot()),
               sphere = test::addMesh(scene, tools::makeUvSphere(100, 100)), cube = test::addBox(scene);
  scene.addObject({.mesh = sphere, .worldFromMesh = {{3.6, 0, 0, 0.1, 0, 3.4, 0, 0.05, 0, 0, 3, 1.4}}});
  scene.addObject({.mesh = cube, .worldFromMesh = at(50.1, 0.2, 4)});
  return {std::move(scene),
          {{.mesh = pot, .direction = {0.1, 0.2, 1}, .distance = 50},
           {.mesh = cube,
            .worldFromMesh = {{0.9, 0.1, 0.2, 50, -0.1, 0.9, 0.3, 0, -0.2, -0.3, 0.9, 0}},
            .direction = {0, 0.01, 1},
            .distance = 50}}};
}

}  // namespace

TEST_CASE("a query that exceeds Capacity::candidates gets Flag::candidates, and the others keep their bits",
          "[subgroups]") {
  size_t refused = 0, answered = 0;
  // Families in which many pairs may touch first as far as floats can tell.
  for (const char* family : {"non-convex", "interlocking", "lattice", "soup"}) {
    const Batch batch = hardBatch(family);
    for (const uint32_t candidates : {1u, 200u, 1000u, 1u << 17}) {
      CAPTURE(family, candidates);
      const fuzz::Outcomes outcomes =
          batch.outcomes({.queries = 48, .candidates = candidates, .rounds = 64, .unresolvedPairs = 1u << 17});
      refused += outcomes.candidates;
      answered += outcomes.answered;
      CHECK(outcomes.rounds + outcomes.unresolved == 0);
      if (candidates == 1u << 17) CHECK(outcomes.candidates == 0);
    }
  }
  CHECK(refused > 50);
  CHECK(answered > 4 * 48);
}

TEST_CASE("a query that exceeds Capacity::rounds gets Flag::rounds, and a short one beside it is answered",
          "[subgroups]") {
  const Batch batch = heavyAndLight();
  const fuzz::Outcomes hasty = batch.outcomes({.queries = 2, .rounds = 2});
  CHECK(hasty.rounds == 1);
  CHECK(hasty.hits == 1);
  const Capacity patient{.queries = 2, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 16};
  CHECK(batch.outcomes(patient).answered == 2);
}

TEST_CASE("rounds are brief on a GPU, and enough of them suffice", "[subgroups]") {
  const Device device = Device::open(test::deviceOptions());
  const Batch batch = hardBatch("soup");
  const auto unfinished = [&](uint32_t rounds) {
    const Capacity capacity{.queries = 48, .candidates = 1u << 17, .rounds = rounds, .unresolvedPairs = 1u << 17};
    return batch.outcomes(capacity, device).rounds;
  };
  device.impl().properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_CPU;
  CHECK(unfinished(2) == 0);
  device.impl().properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
  CHECK(unfinished(2) > 0);
  CHECK(unfinished(64) == 0);
}

TEST_CASE("a query that exceeds Capacity::unresolvedPairs gets Flag::unresolved and a valid lower bound",
          "[subgroups]") {
  // The boxes touch at whole numbers, where only exact arithmetic can decide.
  const Batch batch = hardBatch("lattice");
  size_t unresolved = 0, answered = 0;
  for (const uint32_t unresolvedPairs : {1u, 20u, 100u}) {
    CAPTURE(unresolvedPairs);
    const fuzz::Outcomes outcomes = batch.outcomes({.queries = 48, .rounds = 64, .unresolvedPairs = unresolvedPairs});
    unresolved += outcomes.unresolved;
    answered += outcomes.answered;
    CHECK(outcomes.candidates + outcomes.rounds == 0);
    if (unresolvedPairs == 1) CHECK(outcomes.unresolved > 10);
  }
  CHECK(answered > 10);
  CHECK(unresolved > 20);
  CHECK(batch.outcomes({.queries = 48, .rounds = 64, .unresolvedPairs = 1u << 17}).answered == 48);
}

TEST_CASE("the default capacity suffices for a sensor of many triangles among a few large boxes", "[subgroups]") {
  // A sensor of more than 98 * 64 triangles among 50 boxes that are larger than it.
  tools::Random random(12);
  const tools::MeshData teapot = tools::makeTeapot();
  REQUIRE(teapot.triangleCount() > 98 * 64);
  Scene scene;
  const MeshId pot = test::addMesh(scene, teapot), cube = test::addBox(scene);
  for (int i = 0; i < 50; ++i) {
    const std::array<double, 3> edges = random.inBox({10, 10, 10}, {40, 40, 40});
    scene.addObject({.mesh = cube, .worldFromMesh = tools::makePose(random.rotation(), edges, random.inCube(60))});
  }
  std::vector<Query> queries;
  for (int i = 0; i < 64; ++i) {
    const double scale = random.uniform(0.5, 3);
    queries.push_back({.mesh = pot,
                       .worldFromMesh = tools::makePose(random.rotation(), {scale, scale, scale}, random.inCube(90)),
                       .direction = random.direction(),
                       .distance = 150});
  }
  Batch batch(std::move(scene), queries);
  CHECK(batch.outcomes({}).answered == 64);
  batch.queries.resize(1);
  CHECK(batch.outcomes({}).answered == 1);
}

namespace {

// A sphere of 4,982 triangles with bumps, among 200 such spheres; and rings of 6,144 triangles on pegs.
tools::Workload bumpyBalls(uint32_t sensors) {
  tools::MeshData ball = tools::makeUvSphere(48, 53);
  for (size_t i = 0; i < ball.positions.size(); i += 3) {
    float* p = &ball.positions[i];
    const double bump = 1 + 0.2 * std::sin(9 * p[0] + 1) * std::sin(8 * p[1] + 2) * std::sin(7 * p[2] + 3);
    for (int k = 0; k < 3; ++k) p[k] *= static_cast<float>(bump);
  }
  return tools::makeWorkload(tools::RandomPoses{.meshes = {ball}, .objects = 200, .sensors = sensors});
}
tools::Workload ringsOnPegs(uint32_t sensors) {
  return tools::makeWorkload(tools::InterlockingPairs{.kind = tools::Interlocking::ringOnPeg, .sensors = sensors});
}

}  // namespace

TEST_CASE("the default capacity grows with the number of queries, for sensors of 5,000 triangles") {
  for (const uint32_t count : {64u, 840u}) {
    CAPTURE(count);
    const Batch batch(test::caseOf(bumpyBalls(count)));
    REQUIRE(batch.queries.size() == count);
    CHECK(batch.outcomes({.queries = count}).answered == count);
  }
}

TEST_CASE("where meshes interlock, the default capacity does not suffice, and needed() tells what does") {
  const Batch batch(test::caseOf(ringsOnPegs(64)));
  Capacity capacity{.queries = 64};
  std::vector<fuzz::Outcomes> all;
  do {
    Recorder recorder(test::device(), batch.scene, capacity);
    fuzz::checkRecorded(batch.queries, execute(test::device(), recorder, batch.queries), batch.truth,
                        all.emplace_back());
    capacity = fuzz::enoughFor(recorder);
  } while (all.back().lacking() > 0 && all.size() < 5);
  CHECK(all.front().candidates > 10);
  CHECK(all.back().answered == 64);
}

TEST_CASE("a Recorder refuses an invalid capacity or one beyond the device's limits and names the member") {
  const test::Row row(1);
  const auto refused = [&](const Capacity& capacity, const char* why) {
    CHECK_THROWS_WITH(Recorder(test::device(), row.scene, capacity), test::Contains(why));
  };
  refused({.queries = 1u << 31}, "Capacity::queries: this device allows");
  refused({.candidates = 1u << 30}, "Capacity::candidates: this device allows");
  refused({.rounds = 66}, "Capacity::rounds: this device allows 64, got 66");
  refused({.unresolvedPairs = 1u << 30}, "Capacity::unresolvedPairs: this device allows");
  refused({.rounds = 3}, "Capacity::rounds: expected an even number, got 3");
}

TEST_CASE("an object that floats cannot represent gives Flag::range only to the queries that reach it") {
  Scene scene;
  tools::MeshData huge = tools::makeBox({1, 1, 1});
  for (float& x : huge.positions) x *= 0x1p100f;
  const MeshId cube = test::addBox(scene), mountain = test::addMesh(scene, huge);
  const auto add = [&](MeshId mesh, double x, double scale, double squashed) {
    scene.addObject({.mesh = mesh, .worldFromMesh = {{scale, 0, 0, x, 0, scale, 0, 0.1, 0, 0, squashed, 5}}});
  };
  // Too small; too small relative to the sensor; too flat; of a mesh that is too large, although scaled down; and an
  // ordinary box.
  add(cube, 0, 1e-30, 1e-30);
  add(cube, 10, 1e-14, 1e-14);
  add(cube, 20, 1, 1e-40);
  add(mountain, 30, 0x1p-100, 0x1p-100);
  add(cube, 40, 1, 1);
  std::vector<Query> queries(5, {.mesh = cube, .direction = {0, 0.01, 1}, .distance = 20});
  for (int i = 0; i < 5; ++i) {
    queries[i].worldFromMesh = {{0.9, 0.1, 0.2, 10.0 * i, -0.1, 0.9, 0.3, 0, -0.2, -0.3, 0.9, 0}};
  }
  const std::vector<Result> truth = test::expectedOf(scene, queries);
  for (const Result& result : truth) CHECK(result.status == Status::hit);
  Recorder recorder(test::device(), scene);
  const std::vector<Result> read = execute(recorder, queries);
  for (size_t i = 0; i < 4; ++i) CHECK(test::isRefused(read[i], Flag::range));
  CHECK(test::sameBits(read[4], truth[4]));
}

TEST_CASE("a scene that has become small is searched, however many objects it has had") {
  Scene scene;
  const MeshId cube = test::addBox(scene);
  for (int i = 0; i < 20'000; ++i) scene.addObject({.mesh = cube, .worldFromMesh = at(3 * i, 0, 0)});
  const std::vector<Query> queries{
      {.mesh = cube, .worldFromMesh = at(0.25, 0.5, -5), .direction = {0, 0, 1}, .distance = 20}};
  Recorder recorder(test::device(), scene);
  execute(recorder, queries);
  for (ObjectId id = 1; id < 20'000; ++id) scene.removeObject(id);
  test::checkSame(execute(recorder, queries), test::expectedOf(scene, queries));
}
