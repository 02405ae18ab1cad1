#include <catch2/catch.hpp>

#include "scale/findings.h"
#include "scale/report.h"
#include "support/test_device.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::tools;
using Catch::Matchers::Contains;

namespace {

/// A report of made-up numbers: two devices of which the second is half as fast; 3 queries in 4 ms together.
ScaleReport madeUp() {
  ScaleReport report;
  report.devices = {{.name = "a"}, {.name = "b"}};
  report.numbers = {0, 1};
  report.sensors = {3};
  report.batches = {1};
  report.queries = {3};
  report.processors = 8;
  const auto share = [](uint32_t queries, double busy, double start, double gap, double tail) {
    return DeviceShare{queries, 1, queries, queries, busy, start, gap, tail, 0.1, 0, 0};
  };
  const auto run = [](std::vector<uint32_t> devices, bool alone, double ms, std::vector<DeviceShare> shares) {
    ScaleRun made;
    made.devices = std::move(devices);
    made.alone = alone;
    made.ms = made.least = made.most = ms;
    made.shares = std::move(shares);
    made.batches.resize(1);
    made.batches[0].answered = ms;
    return made;
  };
  report.runs = {run({0}, false, 6, {share(3, 6, 0, 0, 0)}),
                 run({0, 1}, false, 5, {share(2, 4, 0, 0, 1), share(1, 4, 0.25, 0.75, 0)}),
                 run({1}, true, 12, {share(3, 12, 0, 0, 0)})};
  return report;
}

}  // namespace

TEST_CASE("speed-up is against the first device, efficiency against the speeds of all, each alone") {
  const ScaleReport report = madeUp();
  CHECK(report.speedUp(report.run(0, 2)) == Approx(6.0 / 5));
  CHECK(report.efficiency(report.run(0, 2)) == Approx(4.0 / 5));
  CHECK(report.efficiency(report.run(0, 1)) == Approx(1));
  CHECK(report.efficiency(report.alone(0, 1)) == Approx(1));
}

TEST_CASE("the parts of the devices' time add up, and the findings begin with the greatest loss") {
  ScaleReport report = madeUp();
  const Losses losses = lossesOf(report, report.run(0, 2));
  CHECK(losses.useful == Approx(0.8));
  CHECK(losses.tail == Approx(0.1));
  CHECK(losses.gap == Approx(0.075));
  CHECK(losses.start == Approx(0.025));
  CHECK(losses.slower == Approx(0).margin(1e-12));
  std::vector<std::string> findings = findingsOf(report);
  REQUIRE(findings.size() == 4);
  CHECK_THAT(findings[0], Contains("1.20 times as fast") && Contains("80%"));
  CHECK_THAT(findings[1], Contains("imbalance"));
  CHECK_THAT(findings[2], Contains("between chunks"));
  // Each device slower than alone, while this process has all cores.
  report.runs[1].shares[0].busy = 5;
  report.runs[1].shares[0].tail = 0;
  report.runs[1].cores = 7.9;
  findings = findingsOf(report);
  CHECK_THAT(findings[1], Contains("longer for a query than alone") && Contains("8 cores were 99% in use"));
}

TEST_CASE("a measured workload accounts for all time and all queries, with the same bits on every set of devices") {
  const std::vector<Device> devices = openDevices({}, test::onValidation);
  std::vector<ScalePoint> points;
  for (const uint32_t teapots : {2u, 4u}) {
    points.push_back({double(teapots), makeWorkload(Figure7{.teapots = teapots, .boxes = 100, .steps = 2})});
  }
  const ScaleSettings settings{.mode = Mode::contact, .repeats = 1};
  size_t steps = 0;
  ScaleReport report = measureScale(devices, points, settings, [&] { ++steps; });
  report.numbers = {0, 1};
  CHECK(steps == scaleSteps(2, 2, settings));
  CHECK(report.sameBits);
  REQUIRE(report.runs.size() == 6);
  for (const ScaleRun& run : report.runs) {
    uint32_t queries = 0;
    for (const DeviceShare& share : run.shares) queries += share.queries;
    CHECK(queries == report.queries[run.point]);
    const Losses losses = lossesOf(report, run);
    CHECK(losses.useful + losses.slower + losses.start + losses.gap + losses.tail + losses.scene ==
          Approx(1).margin(0.01));
    CHECK(run.stages.empty() == (run.point == 0));
  }
  CHECK_THAT(tableOf(report), Contains("devices 0+1, ") && Contains("readback"));
}
