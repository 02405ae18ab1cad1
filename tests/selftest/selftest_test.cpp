// The selftest of devices: its report is complete whenever it ends.
#include "selftest/selftest.h"

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::tools;
using radar::test::Contains;
using radar::test::Run;
using radar::test::runProgram;
using radar::test::ScratchFolder;

namespace {

// A report with something in every place.
Json madeUp() {
  Json report = lookAtDevices({0});
  report["command"] = "cyber-radar selftest";
  Json& device = report["devices"][0];
  device["number"] = 3;
  device["name"] = "A <device>";
  device["limits"] = {{{"limit", "maxThings"}, {"has", 7}, {"needed", 5}, {"mode", "sampled"}}};
  Json& parts = device["parts"];
  for (Json& part : parts) part["state"] = "done";
  report["together"]["state"] = "impossible";
  parts["arithmetic"]["rows"] = {{{"operation", "float addition"}, {"worst_ulps", 0.5}, {"found", "rounded up"}},
                                 {{"operation", "float copies"}, {"worst_ulps", NAN}, {"found", "the \"same\", all"}}};
  parts["exactness"]["rows"] = {{{"family", "convex"}, {"doubles", true}, {"queries", 64}, {"wrong", 0}}};
  const auto throughput = [](uint64_t batch, double deviceUs, double cpuUs) -> Json {
    return {{"workload", "light"},
            {"batch", batch},
            {"device_us_per_query", deviceUs},
            {"cpu_us_per_query", cpuUs},
            {"cpu_over_device", cpuUs / deviceUs},
            {"differ", 0}};
  };
  parts["throughput"]["rows"] = {throughput(1, 20, 10), throughput(1000, 0.5, 5)};
  parts["stages"]["rows"] = {{{"workload", "light"}, {"stage", "search"}, {"us_per_query", 0.25}},
                             {{"workload", "light"}, {"stage", "solve"}, {"us_per_query", 0.1}}};
  parts["lanes"]["rows"] = {{{"way", "one"}, {"us_per_query", 2.0}, {"times_as_fast", 1.0}},
                            {{"way", "two"}, {"us_per_query", 1.0}, {"times_as_fast", 2.0}}};
  parts["passes"]["rows"] = {{{"workload", "teapots"}, {"stage", "mask"}, {"us_per_query", 7.0}}};
  return report;
}

bool isUnderWay(const Json& part) {
  return part["state"] == "running";
}

}  // namespace

TEST_CASE("a selftest's report tells every number as text, JSON, tables and a page") {
  Json report = madeUp();
  conclude(report);
  CHECK(report["right"] == true);
  report["seconds"] = 12.3456789;
  const std::string text = selftestText(report);
  CHECK_THAT(text, test::StartsWith(selftestSummary(report)) && Contains("\nseconds: 12.35\n"));
  for (const char* said : {"command: cyber-radar selftest\n", "device 3: A <device>\n", "maxThings", "rounded up",
                           "    convex  yes           64      0\n", "exactness: done", "lanes: done",
                           "1065 answers checked, 0 wrong: nothing is wrong", "all devices together: impossible"}) {
    CHECK_THAT(text, Contains(said));
  }
  const std::map<std::string, std::string> files = selftestFiles(report);
  CHECK(files.at("report.txt") == text);
  const nlohmann::json json = nlohmann::json::parse(files.at("report.json"));
  CHECK(json["devices"][0]["parts"]["arithmetic"]["rows"][1]["worst_ulps"].is_null());
  CHECK(files.at("arithmetic.csv") ==
        "device,operation,worst_ulps,found\n3,float addition,0.5,rounded up\n3,float copies,,\"the \"\"same\"\", "
        "all\"\n");
  CHECK(files.at("exactness.csv") == "device,family,doubles,queries,wrong\n3,convex,yes,64,0\n");
  CHECK_THAT(files.at("throughput.csv"), test::EndsWith("\n3,light,1000,0.5,5,10,0\n"));
  CHECK(files.at("stages.csv") ==
        "device,mode,workload,stage,us_per_query\n3,contact,light,search,0.25\n3,contact,light,solve,0.1\n"
        "3,sampled,teapots,mask,7\n");
  const std::string& page = files.at("index.html");
  CHECK_THAT(page, Contains("A &lt;device") && Contains("maxThings") && Contains("rounded up") && Contains("</html>"));
  // A rate of 50,000 beside 2,000,000, a stage of 0.1 beside 0.25, and a lane of half the speed.
  for (const char* bar :
       {"--share:2.5%\">50000<", "--share:40.0%\">0.1<", "--share:50.0%\">1<", "--share:100.0%\">7<"}) {
    CHECK_THAT(page, Contains(bar));
  }
}

TEST_CASE("a selftest's first line says whether all is right, who is faster, by how much, and what to set") {
  Json report = madeUp();
  Json& parts = report["devices"][0]["parts"];
  const auto verdictWith = [&](const std::vector<std::pair<uint64_t, double>>& races) {
    parts["throughput"]["rows"] = Json::array();
    for (const auto& [batch, times] : races) {
      parts["throughput"]["rows"].push_back({{"batch", batch}, {"cpu_over_device", times}, {"differ", 0}});
    }
    conclude(report);
    const std::string text = selftestText(report);
    return text.substr(0, text.find('\n'));
  };
  CHECK(verdictWith({{1, 0.1}, {100, 2.0}, {100, 0.1}, {1000, 2.0}, {1000, 8.0}}) ==
        "RIGHT (2265 answers, 0 wrong); device 3 is 4 times as fast as the CPU, from batches of 1000 on: set "
        "--cpu-batch 1000");
  CHECK(
      verdictWith({{1, 1.5}, {10, 3.14159}}) ==
      "RIGHT (75 answers, 0 wrong); device 3 is 3.14 times as fast as the CPU, whatever the batch: set --cpu-batch 0");
  CHECK(verdictWith({{1, 2.0}, {10, 0.25}}) ==
        "RIGHT (75 answers, 0 wrong); the CPU is 4 times as fast as device 3: set --mode reference");
  CHECK(verdictWith({}) == "RIGHT (64 answers, 0 wrong)");
  parts["lanes"]["state"] = "running";
  CHECK_THAT(verdictWith({{10, 2.0}}), test::StartsWith("UNFINISHED (74 answers, 0 wrong); device 3 is 2 times"));
  parts["lanes"]["state"] = "failed";
  CHECK(verdictWith({{10, 2.0}}) == "WRONG (74 answers, 0 wrong, part lanes of device 3 failed)");
  parts["exactness"]["rows"][0]["wrong"] = 2;
  parts["lanes"]["state"] = "done";
  CHECK(verdictWith({{10, 2.0}}) == "WRONG (74 answers, 2 wrong)");
}

TEST_CASE("a selftest that was interrupted says so, what was checked, and what is wrong so far") {
  Json report = madeUp();
  report["devices"][0]["parts"]["lanes"]["state"] = "running";
  report["devices"][0]["parts"]["passes"]["state"] = "not begun";
  conclude(report);
  CHECK(report["right"] == false);
  CHECK_THAT(selftestText(report), Contains("1065 answers checked, 0 wrong: interrupted when 5 of 7 parts had ended"));
  report["devices"][0]["parts"]["exactness"]["rows"][0]["wrong"] = 1;
  conclude(report);
  CHECK_THAT(selftestText(report), Contains("1065 answers checked, 1 wrong: SOMETHING IS WRONG"));
}

TEST_CASE("a wrong answer, an answer that differs and a part that failed make the report say so") {
  const auto isWrong = [](Json report) {
    conclude(report);
    CHECK(report["right"] == false);
    CHECK_THAT(selftestText(report), Contains("SOMETHING IS WRONG"));
    CHECK_THAT(selftestFiles(report).at("index.html"), Contains("SOMETHING IS WRONG"));
  };
  Json report = madeUp();
  report["devices"][0]["parts"]["exactness"]["rows"][0]["wrong"] = 1;
  isWrong(report);
  report = madeUp();
  report["devices"][0]["parts"]["throughput"]["rows"][1]["differ"] = 1;
  isWrong(report);
  report = madeUp();
  report["devices"][0]["parts"]["lanes"]["state"] = "failed";
  report["devices"][0]["parts"]["lanes"]["note"] = "vkQueueSubmit2 failed";
  isWrong(report);
  CHECK_THAT(selftestText(report), Contains("lanes: failed, 0.0 s: vkQueueSubmit2 failed"));
}

TEST_CASE("a selftest can be read whenever it is interrupted, and every part has at least its first row") {
  Json report = lookAtDevices({});
  REQUIRE(report["devices"].size() == 2);
  const Json &device = report["devices"][0], &other = report["devices"][1];
  std::vector<std::string> begun, parts;
  // So little time that every part is over when it begins: what is measured does not depend on the machine.
  runSelftest(report, 1e-6, [&] {
    const std::map<std::string, std::string> files = selftestFiles(report);
    CHECK(nlohmann::json::parse(files.at("report.json"))["together"].is_object());
    CHECK_THAT(files.at("index.html"), Contains("</html>"));
    // What the files say if the run is interrupted now.
    if (other["parts"]["arithmetic"]["state"] == "not begun") {
      CHECK(report["right"] == false);
      for (const char* file : {"report.txt", "index.html"}) {
        CHECK_THAT(files.at(file), Contains("0 answers checked, 0 wrong: interrupted when 0 of 7 parts had ended"));
      }
      CHECK(device["right"] == (device["parts_ended"] == 7));
      CHECK_THAT(
          files.at("report.txt"),
          Contains(device["right"] ? device["answers_checked"].dump() + " answers checked, 0 wrong: nothing is wrong"
                                   : device["answers_checked"].dump() + " answers checked, 0 wrong: interrupted when " +
                                         device["parts_ended"].dump() + " of 7 parts"));
    }
    for (const auto& [name, part] : device["parts"].items()) {
      if (!isUnderWay(part)) continue;
      begun.push_back(name);
      // Random queries take what all others, on every device, leave.
      CHECK((other["parts"]["passes"]["state"] == "not begun") == (name != "exactness"));
      CHECK_THAT(selftestText(report), Contains(name + ": running"));
      bool isBefore = true;
      for (const auto& [otherName, one] : device["parts"].items()) {
        isBefore = isBefore && otherName != name;
        if (isBefore) CHECK((one["state"] == "done" || one["state"] == "cut short: the time was up"));
        if (!isBefore && otherName != name) CHECK(one["state"] == "not begun");
      }
    }
  });
  for (const auto& [name, part] : device["parts"].items()) {
    CAPTURE(name);
    parts.push_back(name);
    CHECK_FALSE(part["rows"].empty());
  }
  CHECK(begun == parts);
  CHECK(device["right"] == true);
  CHECK(device["parts"]["arithmetic"]["rows"].size() == 26);
  CHECK(device["parts"]["answers"]["rows"].size() == 7);
  CHECK(device["parts"]["lanes"]["rows"].size() == 2);
  CHECK(device["answers_checked"] > 64);
  CHECK(report["right"] == true);
  CHECK(report["together"]["rows"].size() == 3);
}

TEST_CASE("selftest leaves its files, and refuses what makes no sense") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "selftest --minutes 0.1 --device 1 --out report");
  INFO(run.err);
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("device 1: ") && Contains("nothing is wrong"));
  // Standard output has the verdict and what was done; the files have the details.
  const std::string told = run.out.substr(0, run.out.find("\nIn "));
  CHECK_THAT(folder.read("report/report.txt"), test::StartsWith(told) && test::StartsWith("RIGHT ("));
  CHECK_THAT(told, Contains("exactness: ") && !Contains("interlocking"));
  CHECK(nlohmann::json::parse(folder.read("report/report.json"))["right"] == true);
  for (const char* file :
       {"index.html", "arithmetic.csv", "answers.csv", "exactness.csv", "throughput.csv", "stages.csv"}) {
    CAPTURE(file);
    CHECK_FALSE(folder.read(std::string("report/") + file).empty());
  }
  CHECK(std::distance(std::filesystem::directory_iterator(folder.path() / "report"), {}) == 8);
  std::istringstream text(folder.read("report/report.txt"));
  for (std::string line; std::getline(text, line);) CHECK(line.size() <= 120);

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
