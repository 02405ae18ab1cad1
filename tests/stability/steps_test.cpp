// Stability in the plain sense: a sensor's pose moves in tiny steps, and no answer of mode contact may jump further
// than the exact one does.
#include <algorithm>
#include <cmath>

#include "measure/judge.h"
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr uint32_t kCases = 16, kSteps = 4;
constexpr uint64_t kSeed = 3;
constexpr double kStep = 1e-6;  // of the sensor's size

// Each query again and again, its sensor a step further each time.
std::vector<Query> inSteps(const Workload& workload, const Scene& scene) {
  Random random(kSeed * 7'919);
  std::vector<Query> queries;
  for (const Query& query : workload.queries) {
    const Vec3 step = kStep * sensorSize(scene, query) * random.direction();
    for (uint32_t i = 0; i <= kSteps; ++i) {
      moveBy(queries.emplace_back(query).worldFromMesh, static_cast<double>(i) * step);
    }
  }
  return queries;
}

}  // namespace

TEST_CASE("in steps of a millionth the answers of mode contact move with the geometry") {
  Scene scene;
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  CpuSweeper cpu(scene);
  for (const HardFamily& family : hardFamilies()) {
    CAPTURE(family.name);
    const Workload workload = hardScene(family, kSeed, 0, kCases, Company::isolated);
    replaceBy(workload, 0, scene);
    const std::vector<Query> queries = inSteps(workload, scene);
    const std::vector<Result> exact = cpu.run(queries).results, found = sweeper.run(queries).results;
    uint32_t steps = 0;
    for (size_t i = 1; i < queries.size(); ++i) {
      if (i % (kSteps + 1) == 0 || !meets(exact[i - 1]) || !meets(exact[i])) continue;
      ++steps;
      CAPTURE(i);
      REQUIRE(meets(found[i - 1]));
      REQUIRE(meets(found[i]));
      const double own = std::abs(found[i].t - found[i - 1].t), due = std::abs(exact[i].t - exact[i - 1].t);
      CHECK(own - due <= 1e-12 * std::max(sensorSize(scene, queries[i]), exact[i].t));
    }
    CHECK(steps >= 8);
  }
}
