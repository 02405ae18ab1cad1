// The search on the device against the CPU's, on seeded workloads.
#include "agreement/compare.h"
#include "support/catch.h"
#include "workloads/generate.h"

using namespace radar;
using test::compare;

TEST_CASE("on soups of every kind contact is the CPU's answer") {
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const uint32_t triangles = GENERATE(20, 70, 200);
  CAPTURE(origin, triangles);
  const tools::Tally tally =
      compare(tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = triangles, .origin = origin, .seed = 1}))
          .tally;
  CHECK(tally.hits >= 5);
  CHECK(tally.overlaps > 0);
}

TEST_CASE("on Table 1 contact is the CPU's answer") {
  const auto shape = GENERATE(tools::SensorShape::box, tools::SensorShape::teapot);
  CHECK(compare(tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape})).tally.hits >= 20);
}

TEST_CASE("on Figure 7 contact is the CPU's answer, step after step") {
  CHECK(compare(tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12})).tally.hits >= 20);
}
