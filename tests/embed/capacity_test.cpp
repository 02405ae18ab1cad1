// What a recording has room for: a query that outgrows it is invalid, or open, and says why; never is an answer wrong.
#include <catch2/catch.hpp>

#include <cmath>

#include "embed/on_device.h"
#include "embed/renderer.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::execute;
using test::Row;
using test::sameBits;

// Answered on the processor, whatever their number.
std::vector<Result> truthOf(const Scene& scene, std::span<const Query> queries) {
  return Sweeper(test::device(), scene, {.cpuBatch = 100'000}).run(queries);
}

struct Told {
  size_t refused = 0, open = 0, answered = 0;
};

// Each answer is the truth's, to the bit, or has one of `flags` and claims nothing that is not true.
Told tell(std::span<const Query> queries, const std::vector<Result>& read, const std::vector<Result>& truth,
          uint32_t flags) {
  Told told;
  REQUIRE(read.size() == truth.size());
  for (size_t i = 0; i < read.size(); ++i) {
    CAPTURE(i, read[i].flags, read[i].lo, truth[i].t);
    if (read[i].flags == 0) {
      ++told.answered;
      CHECK(sameBits(read[i], truth[i]));
      continue;
    }
    CHECK((read[i].flags & ~flags) == 0);
    CHECK(std::isnan(read[i].t));
    CHECK(std::isnan(read[i].hi));
    CHECK(read[i].object == kNone);
    if (read[i].flags == kFlagUnresolved) {
      ++told.open;
      CHECK(read[i].status == Status::undecided);
      CHECK(read[i].lo <= (truth[i].status == Status::clear ? queries[i].distance : truth[i].hi));
    } else {
      ++told.refused;
      CHECK(read[i].status == Status::invalid);
      CHECK(std::isnan(read[i].lo));
    }
  }
  return told;
}

// Scenes in which many pairs may be first, as far as floats can tell.
constexpr tools::Family kDense[] = {tools::Family::nonConvex, tools::Family::interlocking, tools::Family::lattice,
                                    tools::Family::soup};

struct FamilyQueries {
  explicit FamilyQueries(tools::Family family, uint32_t count = 48) {
    const tools::Workload workload = tools::makeWorkload({.family = family, .queries = count, .seed = 6});
    tools::replaceBy(workload, 0, scene);
    queries = test::queriesOf(workload);
    for (size_t i = 0; i < queries.size(); i += 5) queries[i].anyHit = true;
    truth = truthOf(scene, queries);
  }
  Told told(const Capacity& capacity, uint32_t flags) const {
    Recorder recorder(test::device(), scene, capacity);
    return tell(queries, execute(recorder, queries), truth, flags);
  }
  Scene scene;
  std::vector<Query> queries;
  std::vector<Result> truth;
};

// A teapot inside a sphere, hardly smaller: pairs of nodes without end. And a light query beside it, which hits a box.
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

TEST_CASE("with too little room for candidates queries are refused by that flag, and the others keep their bits",
          "[subgroups]") {
  size_t refused = 0, answered = 0;
  for (const tools::Family family : kDense) {
    const FamilyQueries asked(family);
    for (const uint32_t candidates : {1u, 200u, 1000u, 1u << 17}) {
      CAPTURE(tools::nameOf(family), candidates);
      const Told told = asked.told({.queries = 48, .candidates = candidates, .rounds = 64, .unresolvedPairs = 1u << 17},
                                   kFlagCandidates);
      refused += told.refused;
      answered += told.answered;
      CHECK(told.open == 0);
      if (candidates == 1u << 17) CHECK(told.refused == 0);
    }
  }
  CHECK(refused > 50);
  CHECK(answered > 4 * 48);
}

TEST_CASE("with too few rounds a long search is refused by that flag, and a short one beside it is not",
          "[subgroups]") {
  const HeavyAndLight asked;
  CHECK(asked.truth[1].status == Status::hit);
  Recorder recorder(test::device(), asked.scene, {.queries = 2, .rounds = 2});
  const std::vector<Result> read = execute(recorder, asked.queries);
  CHECK(read[0].flags == kFlagRounds);
  CHECK(tell(asked.queries, read, asked.truth, kFlagRounds).answered == 1);
  Recorder patient(test::device(), asked.scene,
                   {.queries = 2, .candidates = 1u << 18, .rounds = 64, .unresolvedPairs = 1u << 16});
  CHECK(tell(asked.queries, execute(patient, asked.queries), asked.truth, 0).answered == 2);
}

TEST_CASE("with too little room for unresolved pairs queries stay open, with a lower bound that holds", "[subgroups]") {
  // Boxes flush along the way: contact at a whole number, where nothing but exact arithmetic is certain.
  const FamilyQueries asked(tools::Family::lattice);
  size_t open = 0, answered = 0;
  for (const uint32_t unresolvedPairs : {1u, 20u, 100u}) {
    CAPTURE(unresolvedPairs);
    const Told told = asked.told({.queries = 48, .rounds = 64, .unresolvedPairs = unresolvedPairs}, kFlagUnresolved);
    open += told.open;
    answered += told.answered;
    CHECK(told.refused == 0);
    if (unresolvedPairs == 1) CHECK(told.open > 10);
  }
  CHECK(answered > 10);
  CHECK(open > 20);
  CHECK(asked.told({.queries = 48, .rounds = 64, .unresolvedPairs = 1u << 17}, 0).answered == 48);
}

TEST_CASE("with too little room for everything at once no answer is wrong", "[subgroups]") {
  for (const tools::Family family : tools::kFamilies) {
    CAPTURE(tools::nameOf(family));
    const FamilyQueries asked(family, 24);
    asked.told({.queries = 24, .candidates = 100, .rounds = 2, .unresolvedPairs = 10},
               kFlagUnresolved | kFlagCandidates | kFlagRounds);
  }
}

TEST_CASE("a sensor of many triangles among few large boxes is answered with the usual capacity", "[subgroups]") {
  // 99 times 64 triangles, among 50 boxes of which each is larger than it.
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
    const Told told = tell(some, execute(recorder, some), {truth.begin(), truth.begin() + ptrdiff_t(count)}, 0);
    CHECK(told.answered == count);
  }
}

TEST_CASE("more room than a device has, or none, is refused by the member that asks for it") {
  Row row(1);
  const auto refused = [&](const Capacity& capacity, const char* why) {
    CHECK_THROWS_WITH(Recorder(test::device(), row.scene, capacity), Catch::Contains(why));
  };
  refused({.queries = 1u << 31}, "Capacity::queries: this device allows");
  refused({.candidates = 1u << 30}, "Capacity::candidates: this device allows");
  refused({.rounds = 66}, "Capacity::rounds: this device allows 64, got 66");
  refused({.unresolvedPairs = 1u << 30}, "Capacity::unresolvedPairs: this device allows");
  refused({.rounds = 3}, "Capacity::rounds: expected an even number of at least 2, got 3");
  refused({.rounds = 0}, "Capacity::rounds: expected an even number of at least 2, got 0");
  refused({.candidates = 0}, "candidates and unresolvedPairs: expected at least 1 each, got 0");
  refused({.unresolvedPairs = 0}, "candidates and unresolvedPairs: expected at least 1 each, got 0");
}

TEST_CASE("an object that floats cannot hold makes the queries that reach it out of range, and no other") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({1, 1, 1});
  tools::MeshData huge = box;
  for (float& x : huge.positions) x *= 0x1p100f;
  const MeshId cube = scene.addMesh(box.positions, box.indices), mountain = scene.addMesh(huge.positions, huge.indices);
  const auto at = [](double x, double scale, double squashed) {
    return Transform{{scale, 0, 0, x, 0, scale, 0, 0.1, 0, 0, squashed, 5}};
  };
  // Too small; too small beside the sensor; too flat; of a mesh that is too large, made small again; and a usual one.
  scene.addObject({cube, at(0, 1e-30, 1e-30), ~0u});
  scene.addObject({cube, at(10, 1e-14, 1e-14), ~0u});
  scene.addObject({cube, at(20, 1, 1e-40), ~0u});
  scene.addObject({mountain, at(30, 0x1p-100, 0x1p-100), ~0u});
  scene.addObject({cube, at(40, 1, 1), ~0u});
  std::vector<Query> queries;
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
    CHECK(read[i].flags == kFlagRange);
  }
  CHECK(tell(queries, read, truth, kFlagRange).answered == 1);
}
