// The CPU's search at the limits of the range of doubles.
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
    const std::vector<Result> results = sweeper.run(made.queries);
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
    const std::vector<Result> results = sweeper.run(made.queries);
    for (size_t i = 0; i < results.size(); ++i) {
      INFO("query " << i);
      soups::checkTruth(made.scene, made.queries[i], results[i]);
    }
  }
}
