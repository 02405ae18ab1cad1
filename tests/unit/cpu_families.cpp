// The CPU's answers have the same bits on any number of threads, and decisions are those of whole answers.
#include "radar/cpu_sweeper.h"
#include "scene_kinds.h"
#include "support/catch.h"
#include "support/same_bits.h"

using namespace radar;

namespace {

/// On one thread, and on several the same.
std::vector<Result> resultsOf(const Scene& scene, const std::vector<Query>& queries) {
  const Answers expected = CpuSweeper(scene, 1).run(queries);
  for (const uint32_t threads : {2u, 5u}) {
    REQUIRE(test::differenceOf(CpuSweeper(scene, threads).run(queries), expected) == "");
  }
  return expected.results;
}

}  // namespace

TEST_CASE("the CPU's answers are the same on any number of threads, about every kind of scene") {
  for (const kinds::Kind& kind : kinds::all()) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
      kinds::Random random(seed);
      test::Case one;
      kind.make(random, one);
      const std::vector<Result> exact = resultsOf(one.scene, one.queries);
      for (Query& query : one.queries) query.anyHit = true, query.hits = 1;
      const std::vector<Result> decided = resultsOf(one.scene, one.queries);
      for (size_t i = 0; i < exact.size(); ++i) {
        CAPTURE(kind.name, seed, i);
        const bool meets = exact[i].status != Status::clear;
        REQUIRE(decided[i].status == (meets ? Status::hit : Status::clear));
        if (!meets) continue;
        REQUIRE(decided[i].lo == 0);
        REQUIRE(decided[i].hi == (one.queries[i].motion ? 1 : one.queries[i].distance));
      }
    }
  }
}
