// The device's answers held against the CPU's on seeded workloads, in both modes.
#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "measure/timing.h"
#include "support/catch.h"
#include "workloads/generate.h"

using namespace radar;
using test::compare;
using test::Compared;

TEST_CASE("on soups of every kind contact is the CPU's answer, and of mode sampled hi is close to its own pair's") {
  const double origin = GENERATE(0.0, 1e4, 1e7);
  const auto [triangles, resolution] = GENERATE(table<uint32_t, uint32_t>({{20, 16}, {70, 64}, {200, 256}}));
  CAPTURE(origin, triangles, resolution);
  const tools::Workload workload =
      tools::makeWorkload(tools::Soups{.sensors = 64, .triangles = triangles, .origin = origin, .seed = 1});
  const tools::Tally tally = compare(workload).tally;
  CHECK(tally.hits >= 5);
  CHECK(tally.overlaps > 0);
  CHECK(compare(workload, resolution).found() > 0);
}

TEST_CASE(
    "on Table 1 and Figure 7 contact is the CPU's answer, and at 256 nearly all is found, less than a pixel late") {
  const auto table1 = [](tools::SensorShape shape) {
    return tools::makeWorkload(tools::Table1{.boxes = 10'000, .shape = shape});
  };
  for (const tools::Workload& workload : {table1(tools::SensorShape::box), table1(tools::SensorShape::teapot),
                                          tools::makeWorkload(tools::Figure7{.teapots = 10, .steps = 12})}) {
    CAPTURE(workload.scenes.size(), workload.queries[0].mesh);
    CHECK(compare(workload).tally.hits >= 20);
    const Compared sampled = compare(workload, 256);
    CHECK(sampled.found() >= 0.95 * sampled.tally.contacts());
    CHECK(tools::median(sampled.excessInPixels) < 1);
  }
}

TEST_CASE("real meshes, closed and with holes, knotted and convoluted, sweep through each other") {
  for (auto& [name, meshes] : test::realMeshes()) {
    CAPTURE(name);
    const Compared compared =
        compare(tools::makeWorkload(tools::RandomPoses{.meshes = meshes, .objects = 300, .sensors = 40}), 128);
    CHECK(compared.tally.contacts() >= 10);
    CHECK(compared.found() >= 0.8 * compared.tally.contacts());
  }
}

TEST_CASE("the error falls as the resolution grows") {
  const tools::Workload workload =
      tools::makeWorkload(tools::Table1{.boxes = 10'000, .sensors = 128, .shape = tools::SensorShape::teapot});
  double before = 1e300;
  for (uint32_t resolution : {16u, 64u, 256u}) {
    const Compared compared = compare(workload, resolution);
    double mean = 0;  // in units of the sensor, misses as a whole sensor
    for (double excess : compared.excessInPixels) mean += excess / resolution;
    mean = (mean + compared.tally.unseen) / compared.tally.contacts();
    CAPTURE(resolution, mean, before);
    CHECK(mean < before);
    before = mean;
  }
}
