#include "stability/measure.h"

#include "support/catch.h"
#include "support/test_device.h"
#include "workloads/hard_cases.h"

using namespace radar;
using namespace radar::tools;

TEST_CASE("in steps of a millionth the answers of mode contact move with the geometry") {
  const std::vector<StepRow> rows = measureSteps(test::device(), {.cases = 16, .steps = 4, .seed = 3}, [](uint64_t) {});
  size_t expected = 0;
  for (const HardFamily& family : hardFamilies()) expected += offersSampled(family) ? 3 : 1;
  CHECK(rows.size() == expected);
  for (const StepRow& row : rows) {
    CAPTURE(row.family, row.asked.tier());
    CHECK(row.steps >= 8);
    if (row.asked.resolution > 0) continue;
    CHECK(row.flips == 0);
    CHECK(row.excess <= 1e-12);
  }
}
