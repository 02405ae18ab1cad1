// The program with two devices.
#include <algorithm>

#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

TEST_CASE("query on several devices writes the same answers as on one") {
  const ScratchFolder folder;
  succeed(folder, "workload figure7 --teapots 6 --boxes 200 --steps 3 --out w");
  const Run one = succeed(folder, "query w/queries.json --mode contact --device 0");
  for (const char* devices : {"all", "0,1", "1,0"}) {
    const Run run = succeed(
        folder, std::string("query w/queries.json --mode contact --cpu-batch 0 --stats s.json --device ") + devices);
    CHECK(run.out == one.out);
    const auto stats = nlohmann::json::parse(folder.read("s.json"));
    REQUIRE(stats["devices"].size() == 2);
    CHECK(stats["devices"][0]["queries"].get<int>() + stats["devices"][1]["queries"].get<int>() == 18);
  }
}

TEST_CASE("an unknown device or a bad option ends with status 2 and a message that names it") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  succeed(folder, "workload table1 --boxes 20 --sensors 2 --out w");
  checkRefused(folder, "query w/queries.json --mode contact --device 0,7", "device 7 does not exist");
  checkRefused(folder, "query w/queries.json --mode contact --device 1,1", "device 1 is named twice");
  checkRefused(folder, "query w/queries.json --mode contact --device 0,", "--device");
  checkRefused(folder, "query w/queries.json --mode contact --device some", "--device");
  checkRefused(folder, "sweep a.obj a.obj --direction 0 0 1 --distance 1 --device 0,1", "--device");
  checkRefused(folder, "scale --device 9", "device 9 does not exist");
  checkRefused(folder, "scale missing.json", "missing.json");
  checkRefused(folder, "scale --out a.obj", "--out");
  checkRefused(folder, "scale --mode fast", "--mode");
}

TEST_CASE("scale prints tables and writes a table, a chart and a trace") {
  const ScratchFolder folder;
  const Run run = succeed(folder, "scale --sensors 2,3 --boxes 2000 --steps 2 --repeat 1 --resolution 32 --out s");
  CHECK_THAT(run.out, Contains("speed_up") && Contains("\n      3  0+1 ") && Contains("readback"));
  CHECK_THAT(folder.read("s/scale.svg"),
             Contains("mode sampled") && Contains("; commit ") && Contains("<text>0+1</text>") && Contains("</svg>"));
  const std::string csv = folder.read("s/scale.csv");
  CHECK(std::count(csv.begin(), csv.end(), '\n') == 1 + 2 * 4);  // one device, the other, and both: four lines each
  const auto trace = nlohmann::json::parse(folder.read("s/trace.json"));
  size_t chunks = 0;
  for (const auto& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    CHECK(event["ts"].get<double>() >= 0);
    CHECK(event["dur"].get<double>() > 0);
    chunks += event["name"].get<std::string>().starts_with("chunk of");
  }
  CHECK(chunks > 0);
  CHECK(folder.list() == "s");
}

TEST_CASE("scale measures the first queries of each batch of a query file") {
  const ScratchFolder folder;
  succeed(folder, "workload table1 --boxes 100 --sensors 12 --shape box --out w");
  const Run run = succeed(folder, "scale w/queries.json --mode contact --sensors 4,12 --repeat 1");
  CHECK_THAT(run.out, Contains("w/queries.json") && Contains("\n     12  0+1 "));
  CHECK(run.err.empty());
  CHECK_THAT(runProgram(folder, "scale w/queries.json --mode contact --sensors 4 --repeat 1 --device 1").err,
             Contains("warning: there is one device, so nothing is compared"));
}
