// The CPU's answers have the same bits on any number of threads.
#include "cpu_agreement.h"
#include "scene_kinds.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

using namespace radar;
using namespace radar::tools;

namespace {

void check(const Workload& workload) {
  Scene scene;
  replaceBy(workload, 0, scene);
  agreement::ThreadedSweepers(scene).check(queriesOf(workload.queries));
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

TEST_CASE("the CPU's answers are the same on any number of threads for interlocking shapes and over one large mesh") {
  for (const Interlocking kind : kInterlocking) {
    INFO(nameOf(kind));
    check(makeWorkload(InterlockingPairs{.kind = kind, .sensors = 4}));
  }
  check(makeWorkload(OneMesh{.triangles = 20'000, .sensors = 40, .shape = SensorShape::teapot}));
}
