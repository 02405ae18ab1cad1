#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "cli/page_data.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

TEST_CASE("devices lists the devices with their numbers") {
  const ScratchFolder folder;
  const Run run = succeed(folder, "devices");
  CHECK_THAT(run.out, Contains("0  ") && Contains("usable"));
}

TEST_CASE("devices --kernels compiles every kernel") {
  const ScratchFolder folder;
  CHECK_THAT(runProgram(folder, "devices --kernels").out, Contains("contact/search") && Contains("sampled/depth"));
  const auto devices = nlohmann::json::parse(runProgram(folder, "devices --kernels --json").out);
  std::set<std::string> names;
  for (const auto& kernel : devices[0]["kernels"]) {
    CHECK(kernel["ms"].get<double>() > 0);
    names.insert(kernel["kernel"].get<std::string>());
  }
  CHECK(names.size() == devices[0]["kernels"].size());
  CHECK(names.size() > 20);
}

TEST_CASE("mode sampled reports the chosen resolution and writes statistics of its stages") {
  const ScratchFolder folder;
  succeed(folder, "workload table1 --boxes 500 --sensors 16 --out w");
  const Run run = succeed(folder, "query w/queries.json --mode sampled --out a.jsonl --stats s.json");
  CHECK_THAT(run.err, Contains("resolution: "));
  const auto stats = nlohmann::json::parse(folder.read("s.json"));
  CHECK(stats["device"].is_string());
  CHECK(stats["driver"].is_string());
  CHECK_FALSE(stats["stages"].empty());
  const auto first = nlohmann::json::parse(folder.read("a.jsonl").substr(0, folder.read("a.jsonl").find('\n')));
  CHECK(first.contains("paper_min_l"));
}

TEST_CASE("scopes shows R, M and L in a page and writes their values on request") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const Run run = succeed(folder,
                          "scopes a.obj a.obj --at 0.5 0 -3 --direction 0 0 1 --distance 9 --resolution 32 "
                          "--out p --raw");
  const auto data = radar::test::pageData(folder.read("p/scopes.html"));
  CHECK(data["scopes"]["0"]["width"] == 32);
  CHECK(data["others"]["0"]["words"] == "An exact search: free for 3, then it touches object 0.");
  const auto sidecar = nlohmann::json::parse(folder.read("p/scopes.json"));
  CHECK(sidecar["width"] == 32);
  CHECK(sidecar["height"] == 32);
  CHECK(sidecar["d"] == Approx(9));
  CHECK(sidecar["answer"]["t"] == Approx(3));
  // Of a query with options that mode sampled refuses, the pictures are of what it does not.
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"], "scenes": [{"instances": [[0]]}],
    "queries": [{"id": "q", "scene": 0, "sensor": [0, 1,0,0,0.5, 0,1,0,0, 0,0,1,-3], "motion": [0, 0, 9], "hits": "all",
                 "clearance": 0.5, "ignore_leaving": true, "skip_overlapping": true}]})");
  CHECK(runProgram(folder, "scopes q.json --query q --resolution 32 --out q --raw").err.empty());
  for (const std::string name : {"R.f32", "M.f32", "L.f32"}) {
    CHECK(folder.read("p/" + name).size() == 4u * 32 * 32);
    CHECK((folder.read("q/" + name) == folder.read("p/" + name)));
  }
}

TEST_CASE("demo writes a table, queries, answers and a page that opens on a contact") {
  const ScratchFolder folder;
  const Run run = succeed(folder, "demo --out d");
  CHECK_THAT(run.out, Contains("teapot/0") && Contains("reference"));
  CHECK_FALSE(folder.read("d/table.txt").empty());
  const auto data = radar::test::pageData(folder.read("d/demo.html"));
  CHECK(data["queries"]["count"] == 12);
  CHECK(data["tour"].size() == 2);
  CHECK(data["scopes"].contains(std::to_string(data["tour"][0]["query"].get<int>())));
  CHECK(runProgram(folder, "query d/queries.json --mode reference").out == folder.read("d/answers-reference.jsonl"));
}
