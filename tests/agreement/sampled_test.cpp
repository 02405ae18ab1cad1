// Mode sampled against the exact answers, on seeded workloads of every kind.
#include <algorithm>
#include <catch2/catch.hpp>

#include "agreement/compare.h"
#include "bench/statistics.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::Tally;

}  // namespace

TEST_CASE("on soups of every kind hi is never below the exact answer and close to its own pair's") {
  const uint64_t seed = GENERATE(1, 2, 3);
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const uint32_t resolution = GENERATE(16, 64, 256);
  const Tally tally = test::compareWithReference(
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = 100, .origin = origin, .seed = seed}), resolution);
  CAPTURE(seed, origin, resolution, tally.contacts, tally.found, tally.clear);
  CHECK(tally.found > 0);
}

TEST_CASE("at 256 nearly all contacts of Table 1 are found, less than a pixel late") {
  const auto shape = GENERATE(tools::SensorShape::box, tools::SensorShape::teapot);
  const Tally tally =
      test::compareWithReference(tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape}), 256);
  CAPTURE(tally.contacts, tally.found);
  CHECK(tally.found >= 0.95 * tally.contacts);
  CHECK(tools::median(tally.excessInPixels) < 1);
}

TEST_CASE("at 256 nearly all contacts of Figure 7 are found, less than a pixel late") {
  const Tally tally = test::compareWithReference(tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12}), 256);
  CAPTURE(tally.contacts, tally.found);
  CHECK(tally.found >= 0.95 * tally.contacts);
  CHECK(tools::median(tally.excessInPixels) < 1);
}

TEST_CASE("the error falls as the resolution grows") {
  const tools::Workload workload =
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 128, .shape = tools::SensorShape::teapot});
  double before = 1e300;
  for (uint32_t resolution : {16u, 64u, 256u}) {
    Tally tally = test::compareWithReference(workload, resolution);
    double mean = 0;  // in units of the sensor, misses as a whole sensor
    for (double excess : tally.excessInPixels) mean += excess / resolution;
    mean = (mean + tally.contacts - tally.found) / tally.contacts;
    CAPTURE(resolution, mean, before);
    CHECK(mean < before);
    before = mean;
  }
}
