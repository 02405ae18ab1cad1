// The order in which the CPU's search answers a large batch.
#include "cpu/place_order.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/world.h"
#include "workloads/generate.h"

using namespace radar;

TEST_CASE("a large batch is answered place by place, a small one as it comes") {
  test::Case asked =
      test::caseOf(tools::makeWorkload(tools::Table1{.boxes = 300, .sensors = 600, .shape = tools::SensorShape::box}));
  // Two places in turns; one sensor out of range.
  for (size_t i = 0; i < asked.queries.size(); ++i)
    asked.queries[i].worldFromMesh = test::at(i % 2 == 0 ? -40 : 40, 0, 0);
  asked.queries[7].worldFromMesh = test::at(1e200, 0, 0);
  const Scene::Impl& scene = asked.scene.impl();
  cpu::PlaceOrder places;
  const std::span<const uint32_t> order = places.of(asked.queries, scene, scene.objectTree(), 2);
  std::vector<uint32_t> sorted(order.begin(), order.end()), all(asked.queries.size());
  std::iota(all.begin(), all.end(), 0);
  std::ranges::sort(sorted);
  CHECK(sorted == all);
  size_t moves = 0;
  for (size_t i = 1; i < order.size(); ++i) moves += order[i] % 2 != order[i - 1] % 2;
  CHECK(moves <= 2);
  CHECK(places.of(std::span(asked.queries).first(100), scene, scene.objectTree(), 2).empty());
}

TEST_CASE("answers to a large batch are those to its queries one by one") {
  const test::Case asked = test::caseOf(
      tools::makeWorkload(tools::Table1{.boxes = 2'000, .sensors = 1'500, .shape = tools::SensorShape::box}));
  // Queries of all kinds take turns, with few and with many objects excluded.
  std::vector<Query> queries = asked.queries;
  for (size_t i = 0; i < queries.size(); ++i) {
    Query& query = queries[i];
    if (i % 3 == 0) query.hits = kAllHits;
    if (i % 5 < 2) query.exclude.resize(i % 5 == 0 ? 600 : 3);
    std::iota(query.exclude.begin(), query.exclude.end(), ObjectId(i % 1'000));
    query.ignoreLeaving = i % 7 == 1;
    query.skipOverlapping = i % 7 == 2;
    if (i % 7 == 3) query.clearance = 0.1;
    if (i % 7 == 4) {
      query.motion = std::exchange(query.direction, Vector{});
      query.distance = 0;
    }
    if (i % 7 == 5) query.mask = 1 << i % 2;
    query.anyHit = i % 3 == 1 && i % 11 == 0;
  }
  CpuSweeper together(asked.scene, 2), alone(asked.scene, 1);
  const Answers answers = together.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    const Answers one = alone.run(std::span(queries).subspan(i, 1));
    REQUIRE(test::differenceOf(std::span(answers.results).subspan(i, 1), one.results) == "");
    REQUIRE(test::differenceOf(answers.lists[i].hits, one.lists.empty() ? std::vector<Result>{} : one.lists[0].hits) ==
            "");
  }
}
