// sweep with a sensor that turns, or is a ball.
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/page_data.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

/// A rod of length 10 along x, and a post of width 1, both about the origin.
void writeGate(const ScratchFolder& folder) {
  folder.write("rod.obj", "v -5 -.5 0\nv 5 -.5 0\nv 5 .5 0\nv -5 .5 0\nf 1 2 3\nf 1 3 4\n");
  folder.write("post.obj",
               "v -.5 -.5 -1\nv -.5 .5 -1\nv .5 0 -1\nv -.5 -.5 1\nv -.5 .5 1\nv .5 0 1\n"
               "f 1 2 5\nf 1 5 4\nf 2 3 6\nf 2 6 5\nf 3 1 4\nf 3 4 6\n");
}

// The rod lies right of the centre; after a quarter it stands with its left side at the post's edge, at x = 0.5.
const std::string kQuarter = "sweep post.obj rod.obj --mode reference --at 6 -4 0 --centre 1 -4 0 --turn 0 0 2 3 ";

}  // namespace

TEST_CASE("sweep turns its sensor, and says when in the motion it meets what") {
  const ScratchFolder folder;
  writeGate(folder);
  const Run run = succeed(folder, kQuarter + "--json");
  const auto answer = nlohmann::json::parse(run.out);
  CHECK(answer["status"] == "hit");
  CHECK(std::abs(answer["fraction"].get<double>() * 3 - 1.57079632679) < 2e-6);
  const Run words = runProgram(folder, kQuarter);
  CHECK(runProgram(folder, kQuarter + "--json --view v.html").out == run.out);
  CHECK_THAT(words.out, Contains("\nturns by 3 (171.887 degrees) about (0, 0, 2) through (1, -4, 0)\n") &&
                            Contains("hit: first contact after 52.3") && Contains("% of the motion\n") &&
                            Contains("no earlier; certainly at most "));
  CHECK_THAT(runProgram(folder, kQuarter + "--hits all --expect hit").out, Contains("of object 0 (post.obj)"));
  const Run fine = runProgram(folder, kQuarter + "--json --tolerance 1e-9");
  const auto width = [](const nlohmann::json& of) {
    return of["fraction_hi"].get<double>() - of["fraction_lo"].get<double>();
  };
  CHECK(width(nlohmann::json::parse(fine.out)) < 1e-3 * width(answer));
  const Run shown = succeed(folder, kQuarter + "--view v.html");
  CHECK(shown.out == words.out + "page: v.html\n");
  CHECK(pageData(folder.read("v.html"))["queries"]["turns"]["0"]["angle"] == 3);
  const Run free = succeed(folder,
                           "sweep post.obj rod.obj --mode reference --at 6 -4 0 --turn 0 0 1 1.5 "
                           "--direction 0 0 1 --distance 2 --expect clear");
  CHECK_THAT(free.out,
             Contains("moves by (0, 0, 2)\nturns by 1.5 (85.9437 degrees) about (0, 0, 1) through (6, -4, 0)\n") &&
                 Contains("clear: certainly no contact during the motion"));
}

TEST_CASE("a sweep that turns has the answer of the same query in a file") {
  const ScratchFolder folder;
  writeGate(folder);
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["post.obj", "rod.obj"],
    "scenes": [{"instances": [[0]]}], "queries": [{"id": "sweep", "scene": 0, "clearance": 0.25, "motion": [0, 0, 0.5],
    "sensor": [1, 1,0,0,6, 0,1,0,-4, 0,0,1,0], "turn": {"axis": [0.5, 0, 2], "angle": 3, "centre": [6, -4, 0]}}]})");
  const Run found = runProgram(folder, "query q.json --mode reference");
  const Run run = runProgram(folder,
                             "sweep post.obj rod.obj --mode reference --at 6 -4 0 --turn 0.5 0 2 3 "
                             "--direction 0 0 3 --distance 0.5 --clearance 0.25 --json");
  CHECK((run.status == 0 && found.status == 0));
  CHECK_THAT(run.out, Contains("fraction_lo"));
  CHECK(run.out == found.out);
}

TEST_CASE("radar-lab writes hard cases that turn as a query file") {
  const ScratchFolder folder;
  const Run written = succeed(folder, "hard-cases --family 'far centre' --cases 6 --out c", runLab);
  CHECK_THAT(folder.read("c/queries.json"), Contains("\"turn\": {\"axis\": ["));
  const Run run = succeed(folder, "query c/queries.json --mode reference");
  CHECK_THAT(run.out, Contains("\"fraction_hi\": "));
}

TEST_CASE("sweep refuses what is no turn, and what does not go with one, by the option's name") {
  const ScratchFolder folder;
  writeGate(folder);
  for (const auto& [options, words] :
       {std::pair{"--turn 0 0 0 1", "--turn: expected an axis that is not zero"},
        std::pair{"--turn 0 0 1 7e4", "--turn: expected an angle of at most 2^16, got 7"},
        std::pair{"--turn 0 nan 1 1", "--turn: expected finite numbers, got nan"}, std::pair{"--turn 0 0 1", "--turn"},
        std::pair{"--turn 0 0 1 1 --centre 0 0", "--centre"},
        std::pair{"--turn 0 0 1 1 --centre 0 1e300 0", "--centre: expected at most 2^800, got 1e+300"},
        std::pair{"--turn 0 0 1 1 --at 0 1e300 0", "--at: expected at most 2^800"},
        std::pair{"--centre 0 0 0 --direction 0 0 1 --distance 1", "--centre: expected it with --turn"},
        std::pair{"--turn 0 0 1 1 --distance 1", "--direction: expected three numbers, got none"},
        std::pair{"--turn 0 0 1 1 --direction 0 0 1", "--distance: expected a number, got none"},
        std::pair{"--turn 0 0 1 1 --direction 0 0 1 --distance 1e300", "--distance: expected at most 2^800"},
        std::pair{"--turn 0 0 1 1 --speed 2", "--speed: expected none beside --turn"},
        std::pair{"--turn 0 0 1 1 --ignore-leaving --clearance 1",
                  "--ignore-leaving: expected none beside --turn and a clearance"},
        std::pair{"--turn 0 0 1 1 --mode sampled", "--mode: expected contact or reference, as \"turn\""}}) {
    checkRefused(folder, std::string("sweep post.obj rod.obj ") + options, words);
  }
  checkRefused(folder, "scopes post.obj rod.obj --turn 0 0 1 1 --out p", "--turn");
}

TEST_CASE("sweep moves a ball, and refuses one without a radius") {
  const ScratchFolder folder;
  writeGate(folder);
  const std::string down = " --mode reference --at 0 0 5 --direction 0 0 -1 --distance 9 ";
  const Run run = succeed(folder, "sweep rod.obj ball:1.5" + down + "--json --view v.html");
  const auto answer = nlohmann::json::parse(run.out);
  CHECK(std::abs(answer["t"].get<double>() - 3.5) < 2e-6);
  CHECK(pageData(folder.read("v.html"))["meshes"].back()["isRound"] == true);
  const Run farther = runProgram(folder, "sweep rod.obj ball:1.5 --clearance 0.5 --json" + down);
  CHECK(std::abs(nlohmann::json::parse(farther.out)["t"].get<double>() - 3) < 2e-6);
  for (const char* radius : {"", "-1", "nan", "1e400", "2x"}) {
    checkRefused(folder, std::string("sweep rod.obj ball:") + radius + down,
                 std::string("SENSOR: ball:") + radius + ": expected a radius from 0 to 2^1000");
  }
  checkRefused(folder, "scopes rod.obj ball:2 --at 0 0 5 --direction 0 0 -1 --distance 9 --out p",
               "ball:2: expected a sensor without a radius");
}
