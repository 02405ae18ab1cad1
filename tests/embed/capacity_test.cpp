// Capacities of a recording: a query that exceeds one is invalid or unresolved and has its flag; no answer is wrong.
#include <cmath>

#include "embed/on_device.h"
#include "embed/renderer.h"
#include "support/catch.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace {

using namespace radar;
using test::execute;
using test::Row;
using test::sameBits;

// The CPU's answers.
std::vector<Result> truthOf(const Scene& scene, std::span<const Query> queries) {
  return Sweeper(test::device(), scene, {.cpuBatch = 100'000}).run(queries).results;
}

struct Outcomes {
  size_t refused = 0, unresolved = 0, answered = 0;
};

// Checks that each answer has the bits of `truth`, or has one of `flags` and contradicts nothing in `truth`.
Outcomes checkAnswers(std::span<const Query> queries, const std::vector<Result>& read, const std::vector<Result>& truth,
                      uint32_t flags) {
  Outcomes outcomes;
  REQUIRE(read.size() == truth.size());
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(i, read[i].flags, read[i].lo, truth[i].t);
    if (read[i].flags == 0) {
      ++outcomes.answered;
      CHECK(sameBits(read[i], truth[i]));
      continue;
    }
    CHECK((read[i].flags & ~flags) == 0);
    CHECK_FALSE(std::isfinite(read[i].t));
    CHECK_FALSE(std::isfinite(read[i].hi));
    CHECK(read[i].object == kNone);
    if (read[i].flags == Flag::unresolved) {
      ++outcomes.unresolved;
      CHECK(read[i].status == Status::undecided);
      CHECK(read[i].lo <= (truth[i].status == Status::clear ? queries[i].distance : truth[i].hi));
    } else {
      ++outcomes.refused;
      CHECK(read[i].status == Status::invalid);
      CHECK(std::isnan(read[i].lo));
    }
  }
  return outcomes;
}

// Families in which many pairs may touch first as far as floats can tell.
constexpr const char* kDense[] = {"non-convex", "interlocking", "lattice", "soup"};

struct FamilyQueries {
  explicit FamilyQueries(const tools::HardFamily& family, uint32_t count = 48) {
    const tools::Workload workload = tools::hardScene(family, 6, 0, count, tools::Company::mixed);
    tools::replaceBy(workload, 0, scene);
    queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); i += 5) queries[i].anyHit = true;
    truth = truthOf(scene, queries);
  }
  Outcomes outcomes(const Capacity& capacity, uint32_t flags) const {
    Recorder recorder(test::device(), scene, capacity);
    return checkAnswers(queries, execute(recorder, queries), truth, flags);
  }
  Scene scene;
  std::vector<Query> queries;
  std::vector<Result> truth;
};

// A teapot inside a sphere that is hardly larger, so that very many node pairs overlap; and beside it a cheap query
// that hits a box.
struct HeavyAndLight {
  HeavyAndLight() {
    const tools::MeshData teapot = tools::makeTeapot(), ball = tools::makeUvSphere(100, 100),
                          box = tools::makeBox({1, 1, 1});
    const MeshId pot = scene.addMesh(teapot.positions, teapot.indices),
                 sphere = scene.addMesh(ball.positions, ball.indices), cube = scene.addMesh(box.positions, box.indices);
    scene.addObject({sphere, {{3.6, 0, 0, 0.1, 0, 3.4, 0, 0.05, 0, 0, 3, 1.4}}, ~0u});
    scene.addObject({cube, {{1, 0, 0, 50.1, 0, 1, 0, 0.2, 0, 0, 1, 4}}, ~0u});
    queries.push_back({.mesh = pot, .direction = {0.1, 0.2, 1}, .distance = 50});
    queries.push_back({.mesh = cube,
                       .worldFromMesh = {{0.9, 0.1, 0.2, 50, -0.1, 0.9, 0.3, 0, -0.2, -0.3, 0.9, 0}},
                       .direction = {0, 0.01, 1},
                       .distance = 50});
    truth = truthOf(scene, queries);
  }
  Scene scene;
  std::vector<Query> queries;
  std::vector<Result> truth;
};

}  // namespace

TEST_CASE("a query that exceeds Capacity::candidates gets Flag::candidates, and the others keep their bits",
          "[subgroups]") {
  size_t refused = 0, answered = 0;
  for (const char* family : kDense) {
    const FamilyQueries batch(tools::hardFamily(family));
    for (const uint32_t candidates : {1u, 200u, 1000u, 1u << 17}) {
      CAPTURE(family, candidates);
      const Outcomes outcomes = batch.outcomes(
          {.queries = 48, .candidates = candidates, .rounds = 64, .unresolvedPairs = 1u << 17}, Flag::candidates);
      refused += outcomes.refused;
      answered += outcomes.answered;
      CHECK(outcomes.unresolved == 0);
      if (candidates == 1u << 17) CHECK(outcomes.refused == 0);
    }
  }
  CHECK(refused > 50);
  CHECK(answered > 4 * 48);
}

TEST_CASE("a query that exceeds Capacity::rounds gets Flag::rounds, and a short one beside it is answered",
          "[subgroups]") {
  const HeavyAndLight batch;
  CHECK(batch.truth[1].status == Status::hit);
  Recorder recorder(test::device(), batch.scene, {.queries = 2, .rounds = 2});
  const std::vector<Result> read = execute(recorder, batch.queries);
  CHECK(read[0].flags == Flag::rounds);
  CHECK(checkAnswers(batch.queries, read, batch.truth, Flag::rounds).answered == 1);
  Recorder patient(test::device(), batch.scene,
                   {.queries = 2, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 16});
  CHECK(checkAnswers(batch.queries, execute(patient, batch.queries), batch.truth, 0).answered == 2);
}

TEST_CASE("a query that exceeds Capacity::unresolvedPairs gets Flag::unresolved and a valid lower bound",
          "[subgroups]") {
  // The boxes touch at whole numbers, where only exact arithmetic can decide.
  const FamilyQueries batch(tools::hardFamily("lattice"));
  size_t unresolved = 0, answered = 0;
  for (const uint32_t unresolvedPairs : {1u, 20u, 100u}) {
    CAPTURE(unresolvedPairs);
    const Outcomes outcomes =
        batch.outcomes({.queries = 48, .rounds = 64, .unresolvedPairs = unresolvedPairs}, Flag::unresolved);
    unresolved += outcomes.unresolved;
    answered += outcomes.answered;
    CHECK(outcomes.refused == 0);
    if (unresolvedPairs == 1) CHECK(outcomes.unresolved > 10);
  }
  CHECK(answered > 10);
  CHECK(unresolved > 20);
  CHECK(batch.outcomes({.queries = 48, .rounds = 64, .unresolvedPairs = 1u << 17}, 0).answered == 48);
}

TEST_CASE("no answer is wrong when all capacities are too small", "[subgroups]") {
  Outcomes all;
  for (const tools::HardFamily& family : test::recordableFamilies()) {
    CAPTURE(family.name);
    const FamilyQueries batch(family, 24);
    const Outcomes outcomes = batch.outcomes({.queries = 24, .candidates = 100, .rounds = 2, .unresolvedPairs = 10},
                                             Flag::unresolved | Flag::candidates | Flag::rounds);
    all.refused += outcomes.refused;
    all.answered += outcomes.answered;
  }
  CHECK(all.refused > 20);
  CHECK(all.answered > 20);
}

TEST_CASE("the default capacity suffices for a sensor of many triangles among a few large boxes", "[subgroups]") {
  // A sensor of more than 98 * 64 triangles among 50 boxes that are larger than it.
  tools::Random random(12);
  const tools::MeshData teapot = tools::makeTeapot(), box = tools::makeBox({1, 1, 1});
  Scene scene;
  const MeshId pot = scene.addMesh(teapot.positions, teapot.indices), cube = scene.addMesh(box.positions, box.indices);
  REQUIRE(teapot.triangleCount() > 98 * 64);
  for (int i = 0; i < 50; ++i) {
    const std::array<double, 3> edges = random.inBox({10, 10, 10}, {40, 40, 40});
    scene.addObject(
        {cube, tools::makePose(random.rotation(), edges, random.inBox({-60, -60, -60}, {60, 60, 60})), ~0u});
  }
  std::vector<Query> queries;
  for (int i = 0; i < 64; ++i) {
    const double scale = random.uniform(0.5, 3);
    queries.push_back({.mesh = pot,
                       .worldFromMesh = tools::makePose(random.rotation(), {scale, scale, scale},
                                                        random.inBox({-90, -90, -90}, {90, 90, 90})),
                       .direction = random.direction(),
                       .distance = 150});
  }
  const std::vector<Result> truth = truthOf(scene, queries);
  Recorder recorder(test::device(), scene);
  for (const size_t count : {1u, 64u}) {
    const std::span<const Query> some = std::span(queries).first(count);
    const Outcomes outcomes =
        checkAnswers(some, execute(recorder, some), {truth.begin(), truth.begin() + ptrdiff_t(count)}, 0);
    CHECK(outcomes.answered == count);
  }
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

struct WorkloadQueries {
  explicit WorkloadQueries(const tools::Workload& workload) : player(workload), queries(test::queriesOf(workload)) {
    player.show(0);
    truth = truthOf(player.scene(), queries);
  }
  tools::ScenePlayer player;
  std::vector<Query> queries;
  std::vector<Result> truth;
};

}  // namespace

TEST_CASE("the default capacity grows with the number of queries, for sensors of 5,000 triangles") {
  for (const uint32_t count : {64u, 840u}) {
    const tools::Workload balls = bumpyBalls(count), rings = ringsOnPegs(count);
    for (const tools::Workload* workload : {&balls, &rings}) {
      CAPTURE(count, workload == &rings);
      const WorkloadQueries batch(*workload);
      REQUIRE(batch.queries.size() == count);
      Recorder recorder(test::device(), batch.player.scene(), {.queries = count});
      // Without doubles, every contact is left to the CPU: too many of 840 interlocking rings.
      const bool mayLeave = workload == &rings && count > 64 && !test::device().doubles();
      const Outcomes outcomes =
          checkAnswers(batch.queries, execute(recorder, batch.queries), batch.truth, mayLeave ? Flag::unresolved : 0);
      CHECK(outcomes.refused == 0);
      CHECK(outcomes.answered > (mayLeave ? count / 4 : count - 1));
    }
  }
}

TEST_CASE("with the capacity that the last recording needed, the same queries are answered", "[subgroups]") {
  const tools::Workload rings = ringsOnPegs(24);
  const WorkloadQueries interlocking(rings);
  const HeavyAndLight heavy;
  const auto check = [](const Scene& scene, const std::vector<Query>& queries, const std::vector<Result>& truth) {
    Capacity capacity{.queries = 24, .candidates = 100, .rounds = 2, .unresolvedPairs = 1};
    int recordings = 0;
    Outcomes outcomes;
    for (; recordings < 10 && outcomes.answered < queries.size(); ++recordings) {
      Recorder recorder(test::device(), scene, capacity);
      CHECK(recorder.needed().candidates == capacity.candidates);  // nothing has been recorded
      outcomes =
          checkAnswers(queries, execute(recorder, queries), truth, Flag::unresolved | Flag::candidates | Flag::rounds);
      const Capacity needed = recorder.needed();
      CHECK(needed.rounds % 2 == 0);
      if (outcomes.answered == queries.size()) {
        CHECK(needed.candidates <= capacity.candidates);
        CHECK(needed.rounds <= capacity.rounds);
        CHECK(needed.unresolvedPairs <= capacity.unresolvedPairs);
      }
      // With room for what differs from one recording to the next.
      capacity.candidates = std::max(capacity.candidates, needed.candidates + needed.candidates / 4);
      capacity.rounds = std::max(capacity.rounds, needed.rounds);
      capacity.unresolvedPairs =
          std::max(capacity.unresolvedPairs, needed.unresolvedPairs + needed.unresolvedPairs / 4);
    }
    CHECK(outcomes.answered == queries.size());
    CHECK(recordings > 1);
  };
  check(interlocking.player.scene(), interlocking.queries, interlocking.truth);
  check(heavy.scene, heavy.queries, heavy.truth);
}

TEST_CASE("a Recorder refuses an invalid capacity or one beyond the device's limits and names the member") {
  Row row(1);
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
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  tools::MeshData huge = box;
  for (float& x : huge.positions) x *= 0x1p100f;
  const MeshId cube = scene.addMesh(box.positions, box.indices), mountain = scene.addMesh(huge.positions, huge.indices);
  const auto at = [](double x, double scale, double squashed) {
    return Transform{{scale, 0, 0, x, 0, scale, 0, 0.1, 0, 0, squashed, 5}};
  };
  // Too small; too small relative to the sensor; too flat; of a mesh that is too large, although scaled down; and an
  // ordinary box.
  scene.addObject({cube, at(0, 1e-30, 1e-30), ~0u});
  scene.addObject({cube, at(10, 1e-14, 1e-14), ~0u});
  scene.addObject({cube, at(20, 1, 1e-40), ~0u});
  scene.addObject({mountain, at(30, 0x1p-100, 0x1p-100), ~0u});
  scene.addObject({cube, at(40, 1, 1), ~0u});
  std::vector<Query> queries;
  queries.reserve(5);
  for (int i = 0; i < 5; ++i) {
    queries.push_back({.mesh = cube,
                       .worldFromMesh = {{0.9, 0.1, 0.2, 10.0 * i, -0.1, 0.9, 0.3, 0, -0.2, -0.3, 0.9, 0}},
                       .direction = {0, 0.01, 1},
                       .distance = 20});
  }
  const std::vector<Result> truth = truthOf(scene, queries);
  for (const Result& result : truth) CHECK(result.status == Status::hit);
  Recorder recorder(test::device(), scene);
  const std::vector<Result> read = execute(recorder, queries);
  for (size_t i = 0; i < 4; ++i) {
    CAPTURE(i);
    CHECK(read[i].status == Status::invalid);
    CHECK(read[i].flags == Flag::range);
  }
  CHECK(checkAnswers(queries, read, truth, Flag::range).answered == 1);
}

TEST_CASE("a scene that has become small is searched, however many objects it has had") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  const MeshId cube = scene.addMesh(box.positions, box.indices);
  std::vector<ObjectId> objects;
  for (int i = 0; i < 20'000; ++i)
    objects.push_back(scene.addObject({cube, {{1, 0, 0, 3.0 * i, 0, 1, 0, 0, 0, 0, 1, 0}}}));
  const std::vector<Query> queries{{.mesh = cube,
                                    .worldFromMesh = {{1, 0, 0, 0.25, 0, 1, 0, 0.5, 0, 0, 1, -5}},
                                    .direction = {0, 0, 1},
                                    .distance = 20}};
  Recorder recorder(test::device(), scene);
  execute(recorder, queries);
  for (size_t i = 1; i < objects.size(); ++i) scene.removeObject(objects[i]);
  const std::vector<Result> read = execute(recorder, queries);
  CHECK(checkAnswers(queries, read, truthOf(scene, queries), 0).answered == 1);
}
