// The device against the CPU, about every kind of scene.
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/test_device.h"
#include "unit/scene_kinds.h"

using namespace radar;

TEST_CASE("the device's answers and lists have the CPU's bits, about every kind of scene, and none is undecided") {
  const bool varied = GENERATE(false, true);
  for (const kinds::Kind& kind : kinds::all()) {
    size_t hits = 0, onDevice = 0, queries = 0;
    for (uint64_t seed = 0; seed < kind.compared; ++seed) {
      kinds::Random random(seed + (varied ? 300'000 : 200'000));
      test::Case one;
      kind.make(random, one);
      for (Query& query : one.queries) {
        if (varied) kinds::vary(random, query);
        query.anyHit = query.hits == 1 && random.chance(0.2);
        query.closest = query.exit = varied && seed % 4 == 0 && !query.ignoreLeaving;
      }
      CAPTURE(kind.name, varied, seed);
      const Answers expected = CpuSweeper(one.scene, 1).run(one.queries);
      const Answers found = Sweeper(test::device(), one.scene, {.cpuBatch = 0}).run(one.queries);
      REQUIRE(test::differenceOf(found, expected, test::sameButTier) == "");
      for (const Result& result : found.results) {
        REQUIRE(result.status != Status::undecided);
        hits += result.status == Status::hit;
      }
      onDevice += found.results.size() - found.stats.cpuQueries;
      queries += found.results.size();
    }
    CAPTURE(kind.name, varied, hits, onDevice, queries);
    CHECK(20 * hits >= queries);
    if (!varied) CHECK(3 * onDevice >= queries);
  }
}
