// The CPU's search at the limits of the range of doubles.
#include <limits>

#include "cpu_agreement.h"
#include "cpu_wild_scenes.h"

using namespace radar;

TEST_CASE("the CPU's answers are the same on any number of threads at every scale, far away and in singular poses") {
  for (uint64_t seed = 0; seed < 100; ++seed) {
    INFO("seed " << seed);
    wild::Random random(seed);
    wild::Made made;
    wild::make(random, seed % 4 == 0 ? 90 : seed % 4 == 1 ? 40 : 3, made);
    agreement::ThreadedSweepers(made.scene).check(made.queries);
  }
}

TEST_CASE("the CPU's answers equal brute force at every scale, far away and in poses that are nearly singular") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    INFO("seed " << seed);
    wild::Random random(1000 + seed);
    wild::Made made;
    wild::make(random, seed % 2 == 0 ? 150 : 3, made);
    CpuSweeper sweeper(made.scene, 1);
    const std::vector<Result> results = sweeper.run(made.queries).results;
    for (size_t i = 0; i < results.size(); i += 2) {
      INFO("query " << i);
      soups::checkTruth(made.scene, made.queries[i], results[i]);
    }
  }
}

TEST_CASE("the CPU's answers equal brute force for directions at the limits of the range of doubles") {
  for (uint64_t seed = 0; seed < 60; ++seed) {
    INFO("seed " << seed);
    wild::Random random(2000 + seed);
    wild::Made made;
    wild::make(random, 1, made);
    CpuSweeper sweeper(made.scene, 1);
    for (Query& query : made.queries) {
      const int exponent = seed % 2 == 0 ? 1023 : -1074;
      for (double& c : query.direction)
        c = std::ldexp(std::rint(3 * random.uniform(-1, 1)), exponent - (seed % 2 == 0 ? 2 : 0));
      if (query.direction == std::array<double, 3>{}) query.direction[0] = std::ldexp(1.0, exponent);
    }
    const std::vector<Result> results = sweeper.run(made.queries).results;
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("query " << i);
      soups::checkTruth(made.scene, made.queries[i], results[i]);
    }
  }
}

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
