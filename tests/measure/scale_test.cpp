#include "measure/scale.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::tools;
using test::Contains;

namespace {

/// A report of made-up numbers: two devices of which the second is half as fast; 3 queries in 4 ms together.
ScaleReport madeUp() {
  ScaleReport report;
  report.numbers = {0, 1};
  report.sensors = {3};
  report.batches = {1};
  report.queries = {3};
  const auto share = [](uint32_t queries, double busy, double start, double gap, double tail) {
    return DeviceShare{queries, 1, queries, queries, busy, start, gap, tail, 0.1, 0, 0};
  };
  const auto run = [](std::vector<uint32_t> devices, double ms, std::vector<DeviceShare> shares) {
    ScaleRun made;
    made.devices = std::move(devices);
    made.ms = made.least = made.most = ms;
    made.shares = std::move(shares);
    made.batches.resize(1);
    made.batches[0].answered = ms;
    return made;
  };
  report.runs = {run({0}, 6, {share(3, 6, 0, 0, 0)}),
                 run({0, 1}, 5, {share(2, 4, 0, 0, 1), share(1, 4, 0.25, 0.75, 0)}),
                 run({1}, 12, {share(3, 12, 0, 0, 0)})};
  return report;
}

}  // namespace

TEST_CASE("the table tells what is gained, and where the devices' time went") {
  ScaleReport measured = madeUp();
  const auto runs = [&] {
    Json report = newReport("");
    addTables(measured, report);
    return partOf(report, "runs")["rows"];
  };
  const Json row = runs()[1];
  CHECK(row["devices"] == "0+1");
  // Against the first device; against the speeds of all, each alone.
  CHECK(row["speed_up"].get<double>() == Approx(6.0 / 5));
  CHECK(row["efficiency"].get<double>() == Approx(4.0 / 5));
  CHECK(runs()[0]["efficiency"].get<double>() == Approx(1));
  CHECK(runs()[2]["efficiency"].get<double>() == Approx(1));
  CHECK(row["useful_%"].get<double>() == Approx(80));
  CHECK(row["tail_%"].get<double>() == Approx(10));
  CHECK(row["gap_%"].get<double>() == Approx(7.5));
  CHECK(row["start_%"].get<double>() == Approx(2.5));
  CHECK(row["slower_%"].get<double>() == Approx(0).margin(1e-9));
  CHECK(row["encode_%"].get<double>() == Approx(2.5));
  // One device slower than alone.
  measured.runs[1].shares[0].busy = 5;
  CHECK(runs()[1]["slower_%"].get<double>() == Approx(10));
}

TEST_CASE("a measured workload accounts for all time and all queries, with the same bits on every set of devices") {
  const std::vector<Device> devices = openDevices({}, {.onValidation = test::onValidation, .debugNames = false});
  std::vector<ScalePoint> points;
  for (const uint32_t teapots : {2u, 4u}) {
    points.push_back({double(teapots), makeWorkload(Figure7{.teapots = teapots, .boxes = 100, .steps = 2})});
  }
  const ScaleSettings settings{.mode = Mode::contact, .repeats = 1};
  size_t steps = 0;
  const ScaleReport report = measureScale(devices, {0, 1}, points, settings, [&] { ++steps; });
  CHECK(steps == scaleSteps(2, 2, settings));
  CHECK(report.sameBits);
  REQUIRE(report.runs.size() == 6);
  for (const ScaleRun& run : report.runs) {
    uint32_t queries = 0;
    for (const DeviceShare& share : run.shares) queries += share.queries;
    CHECK(queries == report.queries[run.point]);
    CHECK(run.stages.empty() == (run.point == 0));
  }
  Json tables = newReport("");
  addTables(report, tables);
  for (const Json& row : partOf(tables, "runs")["rows"]) {
    double sum = 0;
    for (const char* part : {"useful_%", "slower_%", "start_%", "gap_%", "tail_%", "scene_%"}) {
      sum += row[part].get<double>();
    }
    CHECK(sum == Approx(100).margin(1));
  }
  CHECK_THAT(csvOf(partOf(tables, "stages")["rows"]), Contains("\n0+1,readback,"));
}
