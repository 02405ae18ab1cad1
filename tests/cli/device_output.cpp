#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/catch.h"

using radar::test::Contains;
using radar::test::Run;
using radar::test::runProgram;
using radar::test::ScratchFolder;

namespace {

bool isPng(const std::string& bytes) {
  return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.find("IEND") != std::string::npos;
}

}  // namespace

TEST_CASE("devices lists the devices with their numbers") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "devices");
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("0  ") && Contains("usable"));
}

TEST_CASE("mode sampled reports the chosen resolution and writes statistics of its stages") {
  const ScratchFolder folder;
  REQUIRE(runProgram(folder, "workload table1 --boxes 500 --sensors 16 --out w").status == 0);
  const Run run = runProgram(folder, "query w/queries.json --mode sampled --out a.jsonl --stats s.json");
  REQUIRE(run.status == 0);
  CHECK_THAT(run.err, Contains("resolution: "));
  const auto stats = nlohmann::json::parse(folder.read("s.json"));
  CHECK(stats["device"].is_string());
  CHECK(stats["driver"].is_string());
  CHECK_FALSE(stats["stages"].empty());
  const auto first = nlohmann::json::parse(folder.read("a.jsonl").substr(0, folder.read("a.jsonl").find('\n')));
  CHECK(first.contains("paper_min_l"));
}

TEST_CASE("scopes draws R, M and L and writes their values on request") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const Run run = runProgram(folder,
                             "scopes a.obj a.obj --at 0.5 0 -3 --direction 0 0 1 --distance 9 --resolution 32 "
                             "--out p --raw");
  INFO(run.err);
  REQUIRE(run.status == 0);
  for (const char* name : {"p/R.png", "p/M.png", "p/L.png", "p/scopes.png"}) CHECK(isPng(folder.read(name)));
  const auto sidecar = nlohmann::json::parse(folder.read("p/scopes.json"));
  CHECK(sidecar["width"] == 32);
  CHECK(sidecar["height"] == 32);
  CHECK(sidecar["d"] == Approx(9));
  CHECK(sidecar["answer"]["t"] == Approx(3));
  for (const char* name : {"p/R.f32", "p/M.f32", "p/L.f32"}) CHECK(folder.read(name).size() == 4u * 32 * 32);
}

TEST_CASE("demo writes tables, queries, answers, pictures and a film") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "demo --out d");
  INFO(run.err);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("teapot/0") && Contains("reference"));
  CHECK(isPng(folder.read("d/scene.png")));
  CHECK_FALSE(folder.read("d/table.txt").empty());
  // What was predicted happened: surfaces are apart just before it, and not just after it.
  const std::string flight = folder.read("d/flight.txt");
  CHECK_THAT(flight, Contains("  yes\n") && !Contains("  no\n"));
  const std::string film = folder.read("d/flight.png");
  CHECK(isPng(film));
  CHECK_THAT(film, Contains("acTL") && Contains("fdAT"));
  for (const char* picture : {"d/flight/00.png", "d/flight/48.png"}) CHECK(isPng(folder.read(picture)));
  CHECK(runProgram(folder, "query d/queries.json --mode reference").out == folder.read("d/answers-reference.jsonl"));
}

TEST_CASE("stability runs every family and writes tables") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "stability --cases 48 --resolution 64 --out s");
  INFO(run.out);
  REQUIRE(run.status == 0);
  CHECK_THAT(run.out, Contains("all     sampled          64     48 ") && !Contains("WRONG"));
  const std::string table = folder.read("s/table.csv");
  CHECK(std::count(table.begin(), table.end(), '\n') == 1 + 24 * 3 + 5);  // contact alone answers bodies at rest
  CHECK_THAT(folder.read("s/totals.csv"), Contains("\nall,contact,0,"));
  CHECK_THAT(folder.read("s/families.csv"), Contains("\ninterlocking,"));
  CHECK_THAT(folder.read("s/index.html"), Contains("interlocking"));
}

TEST_CASE("stability can run a single case") {
  const ScratchFolder folder;
  const Run run = runProgram(folder, "stability --family slope --first 40 --cases 1 --resolution 64");
  CHECK(run.status == 0);
  CHECK_THAT(run.out, Contains("all     contact           0      1         1 "));
}
