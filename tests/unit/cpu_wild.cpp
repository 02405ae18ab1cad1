// The CPU's search at the limits of the range of doubles.
#include <limits>

#include "cpu_wild_scenes.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"

using namespace radar;

TEST_CASE("directions from the greatest to the least doubles are answered as far as they can be scaled, else refused") {
  constexpr double kMost = std::numeric_limits<double>::max(), kLeast = std::numeric_limits<double>::denorm_min();
  for (uint64_t seed = 0; seed < 60; ++seed) {
    INFO("seed " << seed);
    wild::Random random(3000 + seed);
    wild::Made made;
    wild::make(random, 1, made);
    for (size_t i = 0; i < made.queries.size(); ++i) {
      const double sign = random.uniform(-1, 1) < 0 ? -1 : 1;
      const double second = i % 3 == 0 ? kMost : i % 3 == 1 ? 0x1p998 : random.uniform(-1, 1) * kMost;
      std::array<double, 3> direction{sign * kMost, second, 4 * kLeast};
      std::swap(direction[0], direction[seed % 3]);
      made.queries[i].direction = direction;
    }
    CpuSweeper sweeper(made.scene, 1);
    const std::vector<Result> results = sweeper.run(made.queries).results;
    // Without the least component the direction can be scaled, and the contact is the same to far more than doubles.
    std::vector<Query> scalable = made.queries;
    for (Query& query : scalable) {
      for (double& c : query.direction) c = std::abs(c) < 1 ? 0 : c;
    }
    const std::vector<Result> expected = sweeper.run(scalable).results;
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("query " << i);
      CHECK(results[i].status == expected[i].status);
      CHECK_FALSE(std::isnan(results[i].lo + results[i].hi));
      CHECK_FALSE(results[i].lo > expected[i].hi);
      CHECK_FALSE(expected[i].lo > results[i].hi);
    }
    Query query = made.queries[0];
    query.direction = {kMost, 0, kLeast};
    CHECK(validate(query, made.scene) == "direction: expected a length below 2^1023 beside a component below 2^-1020");
    query.direction = {0x1p1022, 0, kLeast};
    CHECK(validate(query, made.scene).empty());
  }
}
