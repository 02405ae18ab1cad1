// radar-lab host, as a person runs it, and the model that it prints.
#include <algorithm>
#include <cstdint>
#include <fstream>
#include <sstream>

#include "cli/program.h"
#include "measure/host_model.h"
#include "support/catch.h"

using namespace radar::tools;
using radar::test::checkRefused;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runLab;
using radar::test::ScratchFolder;
using radar::test::StartsWith;

TEST_CASE("the cost of a call is told for each workload, batch and number of threads, and adds up") {
  const ScratchFolder folder;
  const Run run = runLab(folder, "host --queries 1,300 --threads 1,2 --repeat 1 --model --out h");
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, StartsWith("device ") && Contains("host_us") && Contains("A model, not a measurement.") &&
                          Contains("expected_per_s"));
  CHECK_THAT(folder.read("h/model.csv"), StartsWith("workload,batch,device_us,host_batch,"));
  std::istringstream table(folder.read("h/host.csv"));
  std::string line;
  std::getline(table, line);
  CHECK_THAT(line,
             StartsWith("workload,batch,threads,call_us,host_us,check_us,plan_us,submit_us,decode_us,device_us,"));
  size_t rows = 0;
  for (; std::getline(table, line); ++rows) {
    CAPTURE(line);
    std::istringstream cells(line);
    std::string cell;
    for (int i = 0; i < 3; ++i) std::getline(cells, cell, ',');
    double call = 0, host = 0, part = 0, parts = 0;
    char comma = 0;
    cells >> call >> comma >> host >> comma;
    for (int i = 0; i < 4; ++i) {
      cells >> part >> comma;
      CHECK(part > 0);
      parts += part;
    }
    CHECK((host > 0 && call >= host && call >= parts));
  }
  CHECK(rows == 8);
  checkRefused(folder, "host --queries 0", "--queries", runLab);
  checkRefused(folder, "host --queries 300 --model", "expected 1 among --queries", runLab);
  checkRefused(folder, "host --threads 2 --model", "expected 1 among --queries", runLab);
  checkRefused(folder, "host --device 99", "99", runLab);
}

TEST_CASE("the model adds the host's parts up, and takes the greater of host and device") {
  const auto row = [](const char* workload, uint32_t batch, uint32_t threads, double host, double check, double submit,
                      double decode) {
    return Json{{"workload", workload}, {"batch", batch},      {"threads", threads}, {"host_us", host},
                {"check_us", check},    {"submit_us", submit}, {"decode_us", decode}};
  };
  // A call takes 40 us whatever its batch; a query 0.05 us that are serial, and 0.16 us that are not.
  Json measured = Json::array();
  for (const char* workload : {"teapots", "boxes"}) {
    measured.push_back(row(workload, 1, 1, 100, 0.5, 38.5, 1));
    measured.push_back(row(workload, 1'000, 2, 7, 1, 4, 1));  // of two threads: not meant
    measured.push_back(row(workload, 1'000, 1, 0.05 + 0.16 + 0.04, 0.02, 0.08 + 0.03, 0.06 + 0.01));
  }
  const Json rows = modelRows(measured);
  REQUIRE(rows.size() == measuredDevices().size());
  bool isHostBound = false, isDeviceBound = false;
  for (const Json& one : rows) {
    CAPTURE(one.dump());
    const double batch = one["batch"], device = one["device_us"], host = 0.05 + 40 / batch + 0.16 / 16;
    CHECK(one["host_batch"] == 1'000);
    CHECK(one["parallel_us"] == Approx(0.16));
    CHECK(one["serial_us"] == Approx(0.05 + 40 / batch));
    CHECK(one["host_us"] == Approx(host));
    CHECK(one["expected_us"] == Approx(std::max(device, host)));
    CHECK(one["expected_per_s"] == Approx(1e6 / std::max(device, host)));
    CHECK(one["sum_per_s"] == Approx(1e6 / (device + host)));
    CHECK(one["bound_by"] == (device > host ? "device" : "host"));
    (device > host ? isDeviceBound : isHostBound) = true;
  }
  CHECK((isHostBound && isDeviceBound));
  measured.erase(measured.begin());  // a batch of 1
  CHECK_THROWS_WITH(modelRows(measured), Contains("expected a measured batch of teapots of at most 1 queries"));
}

TEST_CASE("the model's device times are those of docs/figures.json") {
  std::ifstream file(RADAR_FIGURES);
  const Json run = Json::parse(file)["performance.md#on-a-gpu"][0];
  CHECK_THAT(kMeasuredDevice,
             StartsWith(run["device"].get<std::string>().substr(0, 30)) && Contains(run["commit"].get<std::string>()));
  for (const MeasuredDevice& device : measuredDevices()) {
    CAPTURE(device.workload, device.batch);
    const bool isKnown = std::ranges::any_of(run["figures"].items(), [&](const auto& one) {
      return one.key().starts_with(device.workload) && one.key().find("1,000,000") == one.key().npos &&
             one.value().size() == 4 && one.value()[0] == device.batch && one.value()[1] == device.us;
    });
    CHECK(isKnown);
  }
}
