// Batches do not change answers, and large meshes are handled.
#include <algorithm>
#include <cmath>

#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/generate.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace {

using namespace radar;
using test::add;
using test::at;
using test::differenceOf;

// SweeperOptions::cpuBatch: all queries on the device, all on the CPU.
constexpr uint32_t kOnDevice = 0, kOnCpu = kNone - 1;

std::vector<Result> oneByOne(Sweeper& sweeper, const std::vector<Query>& queries, Mode mode) {
  std::vector<Result> results;
  for (const Query& query : queries) results.push_back(sweeper.run({&query, 1}, mode).results[0]);
  return results;
}

}  // namespace

TEST_CASE("a batch of any size gives the same bits as one query at a time, in both modes and on the CPU") {
  const auto [mode, cpuBatch] = GENERATE(table<Mode, uint32_t>(
      {{Mode::sampled, kOnDevice}, {Mode::contact, kOnDevice}, {Mode::contact, 500}, {Mode::contact, kNone}}));
  CAPTURE(static_cast<uint32_t>(mode), cpuBatch);
  const test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 1234}), 32);
  Sweeper sweeper(test::device(), asked.scene, {.cpuBatch = cpuBatch});
  const std::vector<Result> single = oneByOne(sweeper, asked.queries, mode);
  CHECK(std::ranges::count(single, Status::hit, &Result::status) > 100);
  for (size_t size : {1, 63, 64, 65, 1234}) {
    CAPTURE(size);
    const Answers answers = sweeper.run(std::span(asked.queries).first(size), mode);
    CHECK(differenceOf(answers.results, std::span(single).first(size)) == "");
    if (size < cpuBatch && cpuBatch != kNone) CHECK(answers.stats.cpuQueries == size);
    // Without doubles, the device may leave some queries unresolved.
    if (size >= cpuBatch && test::device().doubles()) CHECK(answers.stats.cpuQueries == 0);
  }
  if (mode == Mode::sampled) return;
  const Answers onCpu = Sweeper(test::device(), asked.scene, {.cpuBatch = kOnCpu}).run(asked.queries);
  CHECK(differenceOf(onCpu.results, single) == "");
  CHECK(onCpu.stats.cpuQueries == asked.queries.size());
  CHECK(onCpu.stats.submissions == 0);
}

TEST_CASE("a query leaves out exactly the objects that it excludes, however many, and the next one does not") {
  constexpr uint32_t kObjects = 60;
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(6, 12));
  for (uint32_t i = 0; i < kObjects; ++i) scene.addObject({ball, at(3 * i, 0.1 * (i % 3), 5), ~0u});
  const uint32_t cpuBatch = GENERATE(kOnDevice, kOnCpu);
  Sweeper sweeper(test::device(), scene, {.cpuBatch = cpuBatch});
  tools::Random random(19);
  std::vector<Query> queries;
  std::vector<std::vector<ObjectId>> left;
  for (const uint32_t count : {0u, 1u, 16u, 17u, 40u, 0u, 59u, 200u, 3u}) {
    Query query{.mesh = ball, .worldFromMesh = at(-4, 0, 5), .direction = {1, 0, 0}, .distance = 4 * kObjects};
    for (uint32_t i = 0; i < count; ++i) query.exclude.push_back(random.below(kObjects));  // some of them twice
    std::vector<ObjectId>& rest = left.emplace_back();
    for (ObjectId id = 0; id < kObjects; ++id) {
      if (std::ranges::find(query.exclude, id) == query.exclude.end()) rest.push_back(id);
    }
    queries.push_back(query);
  }
  const auto firstOf = [](const std::vector<ObjectId>& rest) { return rest.empty() ? kNone : rest.front(); };
  for (const Mode mode : {Mode::contact, Mode::sampled}) {
    const std::vector<Result> results = sweeper.run(queries, mode).results;
    for (size_t i = 0; i < queries.size(); ++i) CHECK(results[i].object == firstOf(left[i]));
  }
  for (Query& query : queries) query.hits = kAllHits;
  const Answers all = sweeper.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    std::vector<ObjectId> found;
    for (const Result& hit : all.lists[i].hits) found.push_back(hit.object);
    CHECK(found == left[i]);
  }
}

TEST_CASE("batches of both modes by turns have the same bits as those of one mode") {
  const test::Case asked = test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 130}), 32);
  const auto fresh = [&](Mode mode) {
    return Sweeper(test::device(), asked.scene, {.cpuBatch = kOnDevice}).run(asked.queries, mode).results;
  };
  const std::vector<Result> precise = fresh(Mode::contact), coarse = fresh(Mode::sampled);
  Sweeper sweeper(test::device(), asked.scene, {.cpuBatch = kOnDevice});
  for (int round = 0; round < 2; ++round) {
    CHECK(differenceOf(sweeper.run(asked.queries, Mode::sampled).results, coarse) == "");
    CHECK(differenceOf(sweeper.run(asked.queries).results, precise) == "");
  }
}

TEST_CASE("mode contact handles a mesh of 160,000 triangles as an object and as a sensor") {
  Scene scene;
  const MeshId sphere = add(scene, tools::makeUvSphere(200, 400)), cube = add(scene, tools::makeBox({0.5, 0.5, 0.5}));
  REQUIRE(scene.mesh(sphere).triangleCount() > 159'000);
  scene.addObject({sphere, {}, ~0u});
  scene.addObject({cube, at(0.1, 0.2, 20), ~0u});
  Sweeper sweeper(test::device(), scene, {.cpuBatch = GENERATE(kOnDevice, kOnCpu)});
  // The ball's half height above the box's corner that is nearest to its axis, at an offset of (0.1, 0.05).
  const double reach = std::sqrt(1 - 0.1 * 0.1 - 0.05 * 0.05);
  const auto check = [&](const Query& query, ObjectId object, double least, double most) {
    const Result result = sweeper.run({&query, 1}).results[0];
    CHECK(result.status == Status::hit);
    CHECK(result.tier == Tier::contact);
    CHECK(result.object == object);
    CHECK(result.t >= least);
    CHECK(result.t <= most);
    CHECK(result.hi - result.lo <= 1e-9 * 10);
  };
  // The box covers the ball's pole, which is exactly 1 from the centre.
  check({.mesh = cube, .worldFromMesh = at(0.1, 0.2, -5), .direction = {0, 0, 1}, .distance = 10}, 0, 3.75, 3.7500001);
  check({.mesh = cube, .worldFromMesh = at(5, 0.3, 0.25), .direction = {-3, 0, 0}, .distance = 10}, 0, 3.75, 3.76);
  check({.mesh = sphere, .worldFromMesh = at(0, 0, 10), .direction = {0, 0, 1}, .distance = 50}, 1, 8.75, 8.7500001);
  check({.mesh = sphere, .worldFromMesh = at(0.45, 0.5, 10), .direction = {0, 0, 1}, .distance = 50}, 1, 8.75,
        9.75 - reach + 0.001);
  check({.mesh = sphere, .worldFromMesh = at(-0.5, 0.25, -7), .direction = {0, 0, 0.1}, .distance = 50}, 0, 5,
        7 - 2 * 0.9);
  const Query within{.mesh = sphere,
                     .worldFromMesh = {{0.5, 0, 0, 0.1, 0, 0.5, 0, 0, 0, 0, 0.5, 0}},
                     .direction = {1, 0, 0},
                     .distance = 0.2};
  CHECK(sweeper.run({&within, 1}).results[0].status == Status::clear);
}
