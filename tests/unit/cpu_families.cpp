// The CPU's answers have the same bits on any number of threads.
#include "cpu_agreement.h"
#include "scene_kinds.h"
#include "support/answer.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"
#include "workloads/interlocking.h"

using namespace radar;
using namespace radar::tools;

namespace {

void check(const Workload& workload) {
  Scene scene;
  replaceBy(workload, 0, scene);
  agreement::ThreadedSweepers(scene).check(queriesOf(workload.queries));
}

/// The same with D at the contact or one ulp shorter or longer, and with objects excluded or masked out.
void checkVariants(const Workload& workload, uint64_t seed) {
  Scene scene;
  replaceBy(workload, 0, scene);
  CpuSweeper sweeper(scene);
  std::vector<Query> queries = queriesOf(workload.queries);
  tools::Random random(seed);
  for (Query& query : queries) {
    const Result exact = test::answer(sweeper, query);
    if (exact.status == Status::clear) continue;
    const uint32_t which = random.below(5);
    if (which < 3) query.distance = which == 0 ? exact.t : std::nextafter(exact.t, which == 1 ? 0 : INFINITY);
    if (which == 3) query.exclude = {exact.object};
    if (which == 4) query.mask = 1u << random.below(32);
  }
  agreement::ThreadedSweepers(scene).check(queries);
}

}  // namespace

TEST_CASE("the CPU's answers are the same on any number of threads, about every kind of scene") {
  for (const kinds::Kind& kind : kinds::all()) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
      INFO(kind.name << ", seed " << seed);
      kinds::Random random(seed);
      test::Case one;
      kind.make(random, one);
      agreement::ThreadedSweepers(one.scene).check(one.queries);
    }
  }
}

TEST_CASE("the CPU's answers are the same on any number of threads, in all families") {
  for (const HardFamily& family : hardFamilies()) {
    for (uint64_t seed = 1; seed <= 2; ++seed) {
      INFO("family " << family.name << ", seed " << seed);
      const Workload workload = hardScene(family, 100 + seed, 0, 32, Company::mixed);
      check(workload);
      checkVariants(workload, seed);
    }
  }
}

TEST_CASE("the CPU's answers are the same on any number of threads for interlocking shapes and over one large mesh") {
  for (const Interlocking kind : kInterlocking) {
    INFO(nameOf(kind));
    check(makeWorkload(InterlockingPairs{.kind = kind, .sensors = 4}));
  }
  check(makeWorkload(OneMesh{.triangles = 20'000, .sensors = 40, .shape = SensorShape::teapot}));
}
