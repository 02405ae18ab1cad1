// A seeded part of what `cyber-radar stability` asks: every family, every tier.
#include <catch2/catch.hpp>

#include "stability/measure.h"
#include "support/test_device.h"

using namespace radar;
using namespace radar::tools;

TEST_CASE("where methods fail, modes sampled and contact keep every promise") {
  const auto onWrong = [](const std::string& words) { UNSCOPED_INFO(words); };
  const StabilitySettings settings{
      .cases = kCasesPerScene * stabilityFamilies().size(), .seed = 7, .resolutions = {16, 64}};
  const StabilityReport report = measureStability(test::device(), settings, onWrong, [](uint64_t) {});
  CHECK(report.rows.size() == stabilityFamilies().size() * 5);
  for (const StabilityRow& row : report.rows) {
    CAPTURE(row.family, nameOf(row.method), row.resolution);
    CHECK(row.right());
    CHECK(row.cases == kCasesPerScene);
    CHECK(row.contacts >= 5);
    if (row.method == Method::contact) CHECK(std::max(row.late, row.early) <= 1e-12);
  }
}
