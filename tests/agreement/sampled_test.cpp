// Mode sampled against the exact answers, on seeded workloads of every kind.
#include <algorithm>
#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "measure/timing.h"
#include "support/catch.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::Compared;

}  // namespace

TEST_CASE("on soups of every kind hi is never below the exact answer and close to its own pair's") {
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const uint32_t resolution = GENERATE(16, 64, 256);
  CAPTURE(origin, resolution);
  const Compared compared = test::compare(
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = 100, .origin = origin, .seed = 1}), resolution);
  CHECK(compared.found() > 0);
}

TEST_CASE("real meshes, closed and with holes, knotted and convoluted, sweep through each other") {
  for (auto& [name, meshes] : test::realMeshes()) {
    CAPTURE(name);
    const Compared compared =
        test::compare(tools::makeWorkload(tools::RandomPoses{.meshes = meshes, .objects = 300, .sensors = 40}), 128);
    CHECK(compared.tally.contacts() >= 10);
    CHECK(compared.found() >= 0.8 * compared.tally.contacts());
  }
}

TEST_CASE("at 256 nearly all contacts of Table 1 are found, less than a pixel late") {
  const auto shape = GENERATE(tools::SensorShape::box, tools::SensorShape::teapot);
  const Compared compared = test::compare(tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape}), 256);
  CHECK(compared.found() >= 0.95 * compared.tally.contacts());
  CHECK(tools::median(compared.excessInPixels) < 1);
}

TEST_CASE("at 256 nearly all contacts of Figure 7 are found, less than a pixel late") {
  const Compared compared = test::compare(tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12}), 256);
  CHECK(compared.found() >= 0.95 * compared.tally.contacts());
  CHECK(tools::median(compared.excessInPixels) < 1);
}

TEST_CASE("the error falls as the resolution grows") {
  const tools::Workload workload =
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 128, .shape = tools::SensorShape::teapot});
  double before = 1e300;
  for (uint32_t resolution : {16u, 64u, 256u}) {
    const Compared compared = test::compare(workload, resolution);
    double mean = 0;  // in units of the sensor, misses as a whole sensor
    for (double excess : compared.excessInPixels) mean += excess / resolution;
    mean = (mean + compared.tally.unseen) / compared.tally.contacts();
    CAPTURE(resolution, mean, before);
    CHECK(mean < before);
    before = mean;
  }
}
