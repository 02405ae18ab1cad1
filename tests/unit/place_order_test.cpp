// The order in which the CPU's search answers a large batch.
#include "cpu/place_order.h"

#include <algorithm>
#include <numeric>

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
  std::vector<Query> queries = asked.queries;
  for (size_t i = 0; i < queries.size(); i += 3) queries[i].hits = kAllHits;
  CpuSweeper together(asked.scene, 2), alone(asked.scene, 1);
  const Answers answers = together.run(queries);
  for (size_t i = 0; i < queries.size(); ++i) {
    const Answers one = alone.run(std::span(queries).subspan(i, 1));
    REQUIRE(test::differenceOf(std::span(answers.results).subspan(i, 1), one.results) == "");
    REQUIRE(test::differenceOf(answers.lists[i].hits, one.lists.empty() ? std::vector<Result>{} : one.lists[0].hits) ==
            "");
  }
}
