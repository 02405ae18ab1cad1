// Compares the CPU's search with brute force over all pairs in exact arithmetic.
#include "distances.h"
#include "judged.h"
#include "scene_kinds.h"
#include "support/catch.h"

using namespace radar;

TEST_CASE("the CPU's answers, their lists, points and normals are those of brute force, about every kind of scene") {
  const bool varied = GENERATE(false, true);
  for (const kinds::Kind& kind : kinds::all()) {
    oracle::Judged judged;
    for (uint64_t seed = 0; seed < (varied ? kind.judged / 2 : kind.judged); ++seed) {
      kinds::Random random(seed + (varied ? 100'000 : 0));
      test::Case one;
      kind.make(random, one);
      for (Query& query : one.queries) {
        if (varied) kinds::vary(random, query);
      }
      const Answers answers = CpuSweeper(one.scene, 2).run(one.queries);
      for (size_t i = 0; i < one.queries.size(); ++i) {
        const size_t before = judged.faults.size();
        judged.add(one.scene, one.queries[i], answers, i);
        const Result& result = answers.results[i];
        if (result.status != Status::clear && !std::isnan(result.point[0])) {
          const double off = distances::offFromBoth(one.scene, one.queries[i], result);
          if (!(off <= (result.status == Status::hit ? 1e-13 : kind.off))) judged.count("a point off its triangles");
        } else if (result.status == Status::hit) {
          judged.count("no point");
        }
        if (judged.faults.size() != before) UNSCOPED_INFO("a fault in scene " << seed << ", query " << i);
      }
    }
    CAPTURE(kind.name, varied);
    INFO(judged.words());
    CHECK(judged.faults.empty());
    if (!varied) CHECK(judged.hits + judged.overlaps >= kind.contacts);
  }
}
