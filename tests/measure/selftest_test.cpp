// The selftest of devices: its report is complete whenever it ends.
#include "measure/selftest.h"

#include <cmath>
#include <filesystem>
#include <sstream>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::tools;
using radar::test::checkRefused;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runProgram;
using radar::test::ScratchFolder;
using radar::test::StartsWith;

namespace {

Json raceRow(uint64_t batch, double times) {
  return {{"device", 3},         {"workload", "light"},      {"batch", batch},
          {"device_per_s", 1e6}, {"cpu_over_device", times}, {"differ", 0}};
}

// A report with all parts done.
Json madeUp() {
  Json report = lookAtDevices({0});
  for (Json& part : report["parts"]) part["state"] = "done";
  partOf(report, "arithmetic")["rows"] = {{{"device", 3}, {"operation", "float addition"}, {"worst_ulps", NAN}}};
  partOf(report, "exactness")["rows"] = {{{"device", 3}, {"family", "convex"}, {"queries", 64}, {"wrong", 0}}};
  partOf(report, "throughput")["rows"] = {raceRow(1, 0.5), raceRow(1000, 10)};
  return report;
}

std::string verdictOn(Json report) {
  conclude(report);
  CHECK(report["right"] == report["verdict"].get<std::string>().starts_with("RIGHT"));
  CHECK_THAT(reportText(report), StartsWith(report["verdict"].get<std::string>() + "\n"));
  return report["verdict"];
}

}  // namespace

TEST_CASE("a selftest's first line says whether all is right") {
  Json report = madeUp();
  CHECK(verdictOn(report) == "RIGHT (1065 answers, 0 wrong)");
  partOf(report, "lanes")["state"] = "running";
  CHECK(verdictOn(report) == "UNFINISHED (1065 answers, 0 wrong)");
  partOf(report, "lanes")["state"] = "failed";
  CHECK(verdictOn(report) == "WRONG (1065 answers, 0 wrong, part lanes failed)");
  partOf(report, "lanes")["state"] = "done";
  partOf(report, "exactness")["rows"][0]["wrong"] = 2;
  CHECK(verdictOn(report) == "WRONG (1065 answers, 2 wrong)");
}

TEST_CASE("the lines below say of each workload from which size of batch on the device or the CPU is faster") {
  Json report = madeUp();
  const auto linesWith = [&](const std::vector<std::pair<uint64_t, double>>& races) {
    Json& rows = partOf(report, "throughput")["rows"] = Json::array();
    for (const auto& [batch, times] : races) rows.push_back(raceRow(batch, times));
    conclude(report);
    return report["findings"].get<std::vector<std::string>>();
  };
  using Lines = std::vector<std::string>;
  CHECK(linesWith({}).empty());
  CHECK(linesWith({{1, 0.1}, {100, 0.5}, {1000, 2}, {10'000, 3.14159}}) ==
        Lines{"device 3, light, batches of 1 to 100: the CPU is 2 to 10 times as fast",
              "device 3, light, batches of 1000 to 10000: the device is 2 to 3.14 times as fast, from some 316 on"});
  CHECK(linesWith({{1, 1.5}}) == Lines{"device 3, light, batches of 1: the device is 1.5 times as fast"});
  CHECK(linesWith({{1, 0.8}, {10, 0.25}}) ==
        Lines{"device 3, light, batches of 1 to 10: the CPU is 1.25 to 4 times as fast"});
  CHECK(linesWith({{1, 2}, {8, 0.25}}) ==
        Lines{"device 3, light, batches of 1: the device is 2 times as fast",
              "device 3, light, batches of 8: the CPU is 4 times as fast, from some 2 on"});
  partOf(report, "throughput")["rows"][0]["workload"] = "heavy";
  conclude(report);
  CHECK(report["findings"].size() == 2);
  CHECK_THAT(summaryOf(report), Contains("\ndevice 3, heavy, batches of 1: the device is 2 times as fast\n"));
}

TEST_CASE("if anything is wrong, the lines below say what differs, and in which of the device's stages") {
  Json report = madeUp();
  partOf(report, "answers")["rows"] = {{{"device", 3},
                                        {"kind", "lists"},
                                        {"queries", 24},
                                        {"wrong", 2},
                                        {"stage", "describing"},
                                        {"first_wrong", "seed 2, answer 7: t 1, expected 2"}}};
  partOf(report, "exactness")["rows"][0].update({{"wrong", 1}, {"first_wrong", "query 5: point"}});
  partOf(report, "throughput")["rows"][0]["differ"] = 4;
  conclude(report);
  CHECK(report["answers_wrong"] == 7);
  CHECK(
      report["findings"] ==
      Json{
          "answers, device 3, lists: 2 answers differ from the CPU's, in describing; seed 2, answer 7: t 1, expected 2",
          "throughput, device 3, light: 4 answers differ from the CPU's",
          "exactness, device 3, convex: 1 answers differ from the CPU's; query 5: point"});
}

TEST_CASE("a selftest can be read whenever it is interrupted, and every part has at least its first row") {
  Json report = lookAtDevices({});
  REQUIRE(partOf(report, "devices")["rows"].size() == 2);
  std::vector<std::string> begun, parts;
  // So little time that every part is over when it begins: what is measured does not depend on the machine.
  runSelftest(report, 1e-6, [&] {
    CHECK_THAT(
        reportText(report),
        StartsWith("UNFINISHED (" + report["answers_checked"].dump() + " answers, 0 wrong") || StartsWith("RIGHT ("));
    bool isBefore = true;
    for (const Json& part : report["parts"]) {
      if (part["state"] == "running") {
        isBefore = false;
        begun.push_back(part["name"]);
        CHECK_THAT(reportText(report), Contains(begun.back() + ": running"));
      } else if (!isBefore) {
        CHECK(part["state"] == "not begun");
      }
    }
  });
  for (const SelftestPart& one : selftestParts()) {
    CAPTURE(one.name);
    parts.emplace_back(one.name);
    Json& rows = partOf(report, one.name)["rows"];
    CHECK_FALSE(rows.empty());
    if (one.asks != SelftestPart::together) CHECK((rows.front()["device"] == 0 && rows.back()["device"] == 1));
  }
  CHECK(begun == parts);
  CHECK(report["right"] == true);
  CHECK(partOf(report, "arithmetic")["rows"].size() == 2 * 25);
  CHECK(partOf(report, "answers")["rows"].size() == 2 * 7);
  CHECK(partOf(report, "lanes")["rows"].size() == 2 * 2);
  CHECK(partOf(report, "together")["rows"].size() == 3);
  CHECK(report["answers_checked"] > 2 * 64);
}

TEST_CASE("selftest leaves its files, and refuses what makes no sense") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "selftest --minutes 0.1 --device 1 --out report");
  INFO(run.err);
  CHECK(run.status == 0);
  // Standard output has the verdict and what was done; the files have the details.
  const std::string told = run.out.substr(0, run.out.find("\nIn "));
  CHECK_THAT(folder.read("report/report.txt"), StartsWith(told) && StartsWith("RIGHT ("));
  CHECK_THAT(told, Contains("exactness: ") && !Contains("interlocking"));
  CHECK(nlohmann::json::parse(folder.read("report/report.json"))["right"] == true);
  for (const char* file : {"index.html", "devices.csv", "limits.csv", "arithmetic.csv", "answers.csv", "exactness.csv",
                           "throughput.csv", "stages.csv", "lanes.csv", "passes.csv"}) {
    CAPTURE(file);
    CHECK_FALSE(folder.read(std::string("report/") + file).empty());
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "report"), {}) == 13);
  std::istringstream text(folder.read("report/report.txt"));
  for (std::string line; std::getline(text, line);) CHECK(line.size() <= 120);

  folder.write("file", "taken");
  checkRefused(folder, "selftest --out file", "expected a folder");
  checkRefused(folder, "selftest --device 99 --out none", "device 99 does not exist");
  checkRefused(folder, "selftest --device some --out none", "--device");
  checkRefused(folder, "selftest --device 1,1 --out none", "device 1 is named twice");
  checkRefused(folder, "selftest --minutes 0 --out none", "--minutes");
  checkRefused(folder, "selftest --minutes nan --out none", "--minutes");
  checkRefused(folder, "selftest", "--out");
}
