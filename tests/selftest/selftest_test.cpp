// The selftest of devices: its report is complete whenever it ends.
#include "selftest/selftest.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"

using namespace radar;
using namespace radar::tools;
using Catch::Contains;
using radar::test::Run;
using radar::test::runProgram;
using radar::test::ScratchFolder;

namespace {

// A report with something in every place.
SelftestReport madeUp() {
  SelftestReport report{.command = "cyber-radar selftest", .commit = "abc", .date = "2026-01-02", .processor = "a CPU"};
  report.minutes = 2;
  report.seconds = 90;
  DeviceTest& device = report.devices.emplace_back();
  device.number = 3;
  device.facts = {.name = "A <device>", .driver = "1.2", .type = "other", .version = "1.3.1", .doubles = true};
  device.facts.limits = {{"maxThings", 5, 7, Mode::sampled}};
  device.arithmetic = {{"float addition", 10, 0, 0.5, "rounded up", "less than 1 ulp off", "bounds hold"},
                       {"float copies", 10, 0, std::nan(""), "same", "the \"same\", all bits", "fine"}};
  device.exactness = {{"convex", true, {.queries = 64, .hits = 60, .pairs = 100, .cpuPairs = 4}}};
  device.throughput = {{"light", 1, 20, 10, 0}, {"light", 1000, 0.5, 5, 0}};
  device.stages = {{"light", "search", 0.25}};
  device.lanes = {{"one", 2, 1}, {"two", 1, 2}};
  device.passes = {{"teapots", "mask", 7}};
  for (PartReport& part : device.parts) part = {PartState::done, "", 1};
  report.togetherState = {PartState::impossible, "there is one usable device", 0};
  return report;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

}  // namespace

TEST_CASE("a selftest's report tells every number as text, JSON, tables and a page") {
  const SelftestReport report = madeUp();
  CHECK(report.right());
  const std::string text = textOf(report);
  for (const char* said : {"device 3: A <device>", "maxThings", "rounded up", "convex", "light", "search", "two",
                           "mask", "nothing is wrong"}) {
    CHECK_THAT(text, Contains(said));
  }
  CHECK_THAT(text, Contains("1065 answers checked, 0 wrong"));
  const nlohmann::json json = nlohmann::json::parse(jsonOf(report));
  CHECK(json["right"] == true);
  const nlohmann::json& device = json["devices"][0];
  CHECK(device["arithmetic"][0]["worst_ulps"] == 0.5);
  CHECK(device["arithmetic"][1]["worst_ulps"].is_null());
  CHECK(device["throughput"][1]["cpu_us_per_query"] == 5.0);
  CHECK(device["parts"]["passes"]["state"] == "done");
  CHECK(device["limits"][0]["mode"] == "sampled");
  CHECK(linesOf(arithmeticCsv(report))[2] == "3,float copies,10,0,,same,\"the \"\"same\"\", all bits\",fine");
  CHECK(linesOf(exactnessCsv(report))[1] == "3,convex,yes,64,60,0,0,0,100,4");
  CHECK(linesOf(throughputCsv(report))[2] == "3,light,1000,0.5,5,0");
  CHECK(linesOf(stagesCsv(report))[2] == "3,sampled,teapots,mask,7");
  const std::string page = htmlOf(report);
  CHECK_THAT(page, Contains("A &lt;device") && Contains("--share:2.5%") && Contains("maxThings") &&
                       Contains("rounded up") && Contains("</html>"));
}

TEST_CASE("a wrong answer, a wrong bit and a part that failed make the report say so") {
  const auto isWrong = [](const SelftestReport& report) {
    CHECK_FALSE(report.right());
    CHECK_THAT(textOf(report), Contains("SOMETHING IS WRONG"));
    CHECK_THAT(htmlOf(report), Contains("Something is wrong here"));
    CHECK(nlohmann::json::parse(jsonOf(report))["right"] == false);
  };
  SelftestReport report = madeUp();
  report.devices[0].exactness[0].tally.wrong = 1;
  isWrong(report);
  report = madeUp();
  report.devices[0].throughput[0].differ = 1;
  isWrong(report);
  report = madeUp();
  report.devices[0][Part::lanes] = {PartState::failed, "vkQueueSubmit2 failed", 1};
  isWrong(report);
  CHECK_THAT(textOf(report), Contains("failed: vkQueueSubmit2 failed"));
}

TEST_CASE("a selftest can be read whenever it is interrupted, and every part has at least its first row") {
  SelftestReport report;
  // So little that every part is over when it begins: what is measured does not depend on the machine.
  lookAtDevices({.minutes = 1e-6}, report);
  REQUIRE(report.devices.size() == 2);
  std::vector<Part> begun;
  runSelftest(report, [&] {
    const nlohmann::json json = nlohmann::json::parse(jsonOf(report));
    CHECK_THAT(htmlOf(report), Contains("</html>"));
    for (const Part part : kParts) {
      if (report.devices[0][part].state != PartState::running) continue;
      CHECK(report.devices[1][Part::arithmetic].state == PartState::notBegun);
      begun.push_back(part);
      CHECK(json["devices"][0]["parts"][nameOf(part)]["state"] == "running");
      CHECK_THAT(textOf(report), Contains(std::string(nameOf(part)) + ": running when this was written"));
      for (const Part before : kParts) {
        const PartState state = report.devices[0][before].state;
        if (before < part) CHECK((state == PartState::done || state == PartState::cut));
        if (before > part) CHECK(state == PartState::notBegun);
      }
    }
  });
  CHECK(begun == std::vector<Part>(kParts.begin(), kParts.end()));
  const DeviceTest& device = report.devices[0];
  CHECK(device.right());
  CHECK(device.arithmetic.size() == 20);
  CHECK(device.checkedAnswers() > 64);
  CHECK_FALSE(device.throughput.empty());
  CHECK_FALSE(device.stages.empty());
  CHECK(device.lanes.size() == 2);
  CHECK_FALSE(device.passes.empty());
  CHECK(report.right());
  CHECK(report.together.size() == 3);
}

TEST_CASE("selftest leaves its files, and refuses what makes no sense") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "selftest --minutes 0.1 --device 1 --out report");
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("device 1: ") && Contains("nothing is wrong"));
  for (const char* file :
       {"index.html", "report.txt", "report.json", "arithmetic.csv", "exactness.csv", "throughput.csv", "stages.csv"}) {
    CAPTURE(file);
    CHECK_FALSE(folder.read(std::string("report/") + file).empty());
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "report"), {}) == 7);

  folder.write("file", "taken");
  const auto refused = [&](const std::string& arguments, const std::string& what) {
    CAPTURE(arguments);
    const Run one = runProgram(folder, "selftest " + arguments);
    CHECK(one.status == 2);
    CHECK_THAT(one.err, Contains(what));
  };
  refused("--out file", "expected a folder");
  refused("--device 99 --out none", "device 99 does not exist");
  refused("--device some --out none", "--device");
  refused("--device 1,1 --out none", "device 1 is named twice");
  refused("--minutes 0 --out none", "--minutes");
  refused("--minutes nan --out none", "--minutes");
  refused("", "--out");
}
