#include <nlohmann/json.hpp>
#include <vector>

#include "cli/page_data.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

/// Writes queries in which a triangle in the plane z = 0 moves up towards others.
void writeTriangles(const ScratchFolder& folder) {
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"id": "a", "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,5]]},
               {"id": "b", "base": 0, "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,2]], "masks": [[1, 2]]},
               {"id": "c", "base": 0, "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,3]]}],
    "queries": [{"id": "far", "scene": 0, "sensor": [0], "dir": [0,0,2], "D": 8, "speed": 10},
                {"id": "near", "scene": 1, "sensor": [0], "dir": [0,0,1], "D": 8},
                {"id": "masked", "scene": 1, "sensor": [0], "dir": [0,0,1], "D": 8, "mask": 5},
                {"id": "excluded", "scene": 2, "sensor": [0], "exclude": [1], "dir": [0,0,1], "D": 8},
                {"id": "moved", "scene": 2, "sensor": [0], "dir": [0,0,1], "D": 3},
                {"id": "short", "scene": 2, "sensor": [0], "dir": [0,0,1], "D": 2.5},
                {"id": "again", "scene": 0, "batch": 9, "sensor": [0, 1,0,0,1, 0,1,0,0, 0,0,1,5], "dir": [0,0,1],
                 "D": 0}]})");
}

}  // namespace

TEST_CASE("query answers in the order of the file and respects base scenes, masks and exclusions") {
  const ScratchFolder folder;
  writeTriangles(folder);
  const Run run = succeed(folder, "query q.json --mode reference");
  const auto answers = linesOf(run.out);
  REQUIRE(answers.size() == 7);
  const struct {
    const char *id, *status;
    double t;
    int object;
  } expected[] = {{"far", "hit", 5, 0},      {"near", "hit", 2, 1},  {"masked", "hit", 5, 0},
                  {"excluded", "hit", 5, 0}, {"moved", "hit", 3, 1}, {"short", "clear", -1, 0},
                  {"again", "overlap", 0, 0}};
  for (size_t i = 0; i < answers.size(); ++i) {
    CAPTURE(answers[i].dump());
    CHECK(answers[i]["id"] == expected[i].id);
    CHECK(answers[i]["status"] == expected[i].status);
    if (expected[i].t < 0) {
      CHECK(answers[i]["t"].is_null());
    } else {
      CHECK(answers[i]["t"] == expected[i].t);
      CHECK(answers[i]["object"] == expected[i].object);
    }
    CHECK(answers[i]["tier"] == "reference");
    CHECK_FALSE(answers[i].contains("paper_min_l"));
  }
  CHECK(answers[0]["time"] == 0.5);
  CHECK(answers[0]["fraction"] == 5.0 / 8);
}

TEST_CASE("query reads a query file from standard input, whose paths are relative to the current folder") {
  const ScratchFolder folder;
  writeTriangles(folder);
  const Run run = succeed(folder, "query - --mode reference <q.json");
  CHECK_FALSE(run.out.empty());
  CHECK(run.out == runProgram(folder, "query q.json --mode reference").out);
  const Run refused = runProgram(folder, "query -");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("standard input: expected valid JSON"));
}

TEST_CASE("query answers once for its statistics, and --repeat asks for more") {
  const ScratchFolder folder;
  writeTriangles(folder);
  for (const auto& [options, passes] : {std::pair{"", 1}, std::pair{"--repeat 2", 3}}) {
    const Run run = succeed(folder, std::string("query q.json --stats s.json --device all ") + options);
    const auto stats = nlohmann::json::parse(folder.read("s.json"));
    CHECK_FALSE(stats["stages"].empty());
    int answered = 0;
    for (const auto& device : stats["devices"]) answered += device["queries"].get<int>();
    CHECK(answered == 7 * passes);
  }
}

TEST_CASE("answers about an assembly name the objects") {
  const ScratchFolder folder;
  writeTriangles(folder);
  folder.write("b.obj", "v 0 0 2\nv 4 0 2\nv 0 4 2\nv 0 0 3\nv 4 0 3\nv 0 4 3\no floor\nf 1 2 3\no roof\nf 4 5 6\n");
  folder.write("assembly.json", R"({"format": "cyber-radar-queries-1", "meshes": ["b.obj#floor"],
    "scenes": [{"id": "a", "assembly": "b.obj"}],
    "queries": [{"id": "up", "scene": 0, "sensor": [0], "exclude": [0], "dir": [0,0,1], "D": 8, "hits": "all"},
                {"id": "down", "scene": 0, "sensor": [0], "exclude": [0], "dir": [0,0,-1], "D": 8},
                {"id": "left out", "scene": 0, "sensor": [0, 0,0,1,-1, 0,1,0,1, 1,0,0,2.5], "dir": [0,0,-1], "D": 1,
                 "skip_overlapping": true, "exclude": [0]}]})");
  const Run run = succeed(folder, "query assembly.json --mode reference");
  const auto answers = linesOf(run.out);
  REQUIRE(answers.size() == 3);
  CHECK((answers[2]["status"] == "clear" && answers[2]["overlapping"] == nlohmann::json({1})));
  CHECK(answers[2]["overlapping_names"] == nlohmann::json({"roof"}));
  CHECK((answers[0]["t"] == 1 && answers[0]["object"] == 1 && answers[0]["object_name"] == "roof"));
  CHECK(answers[0]["hits"][0]["object_name"] == "roof");
  CHECK(answers[1]["object_name"].is_null());
  const Run words = runProgram(folder, "sweep b.obj#roof b.obj#floor --direction 0 0 1 --distance 9");
  CHECK_THAT(words.out, Contains("hit: first contact after 1 of 9") && Contains("b.obj#roof"));
}

TEST_CASE("query writes answers and statistics to files") {
  const ScratchFolder folder;
  writeTriangles(folder);
  const Run plain = runProgram(folder, "query q.json --mode reference");
  const Run run = succeed(folder, "query q.json --mode reference --out a.jsonl --stats s.json --repeat 3");
  CHECK(run.out.empty());
  CHECK(folder.read("a.jsonl") == plain.out);
  CHECK(folder.list() == "a.jsonl a.obj q.json s.json");
  const auto stats = nlohmann::json::parse(folder.read("s.json"));
  CHECK(stats["queries"] == 7);
  CHECK(stats["batches"] == 4);
  for (const char* key : {"load_ms", "setup_ms", "sweep_ms", "host_us_per_query"}) CHECK(stats[key].get<double>() > 0);
  CHECK(stats["stages"].is_object());
  CHECK(stats["pairs"].get<int>() >= 6);
  CHECK(stats["cpu_pairs"] == stats["pairs"]);
  CHECK(stats["cpu_queries"] == 7);
  // Mode contact leaves few queries to the CPU whole, which counts what it does as mode reference does.
  succeed(folder, "query q.json --cpu-batch 100 --stats s.json");
  const auto left = nlohmann::json::parse(folder.read("s.json"));
  for (const char* key : {"pairs", "cpu_pairs", "cpu_queries"}) CHECK(left[key] == stats[key]);
  CHECK(stats["device"].is_null());
  CHECK(stats["driver"].is_null());
  CHECK(stats["commit"].is_string());
  CHECK(runProgram(folder, "query q.json").out == runProgram(folder, "query q.json --mode contact").out);
}

TEST_CASE("sweep describes the contact in words, and --json prints the answer line") {
  const ScratchFolder folder;
  writeTriangles(folder);
  const std::string arguments = "sweep a.obj a.obj --at 0 0 -3 --rotate 0 0 1 90 --direction 0 0 1 --distance 9 ";
  const Run words = succeed(folder, arguments + "--speed 2");
  CHECK_THAT(words.out,
             Contains("hit: first contact after 3 of 9") && Contains("object 0 (a.obj)") && Contains("after 1.5 s"));
  const Run crossing = runProgram(folder,
                                  "sweep a.obj a.obj --at 1 1 -1 --rotate 0 1 0 -90 --direction 0 0 1 --distance 2 "
                                  "--mode reference --skip-overlapping");
  CHECK_THAT(crossing.out,
             Contains("clear: certainly no contact within 2\n  without object 0 (a.obj), whose surface crosses"));
  const Run json = runProgram(folder, arguments + "--json");
  const auto answers = linesOf(json.out);
  REQUIRE(answers.size() == 1);
  CHECK(answers[0]["t"] == 3);
  CHECK_FALSE(answers[0].contains("time"));
  const Run clear = runProgram(folder, "sweep a.obj a.obj --at 0 0 -3 --direction 0 0 -1 --distance 9");
  CHECK_THAT(clear.out, Contains("clear: certainly no contact within 9"));
}

TEST_CASE("workload writes the same files each time, and query answers them") {
  const ScratchFolder folder;
  writeTriangles(folder);
  for (const std::string name :
       {"table1 --boxes 200 --sensors 9 --shape box", "figure7 --teapots 3 --boxes 40 --steps 3",
        "scale --boxes 100 --sensors 5", "soup --objects 10 --sensors 12 --triangles 6",
        "interlocking --shape comb-in-comb --sensors 4", "meshes --mesh a.obj --objects 5 --sensors 4", "hard-cases"}) {
    CAPTURE(name);
    for (const std::string place : {"one", "two"}) {
      const std::string out = " --out " + place;
      const Run written = name == "hard-cases" ? runLab(folder, name + " --family thin --first 2 --cases 4" + out)
                                               : runProgram(folder, "workload " + name + out);
      REQUIRE(written.status == 0);
    }
    CHECK(folder.read("one/queries.json") == folder.read("two/queries.json"));
    CHECK(folder.read("one/scene-0.npy") == folder.read("two/scene-0.npy"));
    const Run run = succeed(folder, "query one/queries.json");
    CHECK(linesOf(run.out).size() >= 4);
  }
}

TEST_CASE("help shows examples, and a call without a command points to the help") {
  const ScratchFolder folder;
  CHECK_THAT(runProgram(folder, "--help").out, Contains("cyber-radar demo"));
  for (const char* command : {"sweep", "query", "scopes", "view", "workload"}) {
    const Run run = succeed(folder, std::string(command) + " --help");
    CHECK_THAT(run.out, Contains("Examples:"));
  }
  const Run nothing = runProgram(folder, "");
  CHECK(nothing.status == 2);
  CHECK_THAT(nothing.err, Contains("--help"));
}

TEST_CASE("query leaves what the sensor rests on, skips what it crosses and lists several contacts") {
  const ScratchFolder folder;
  // A unit cube, wound outwards.
  folder.write("cube.obj",
               "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
               "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
  // A floor, two walls at 3 and 5, and a cube that crosses the sensor.
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["cube.obj"],
    "scenes": [{"id": "room", "instances": [[0, 20,0,0,-9, 0,20,0,-9, 0,0,1,-1], [0, 1,0,0,3, 0,1,0,0, 0,0,1,0],
                                            [0, 1,0,0,5, 0,1,0,0, 0,0,1,0], [0, 1,0,0,0.5, 0,1,0,0.5, 0,0,1,0.5]]}],
    "queries": [{"id": "up", "scene": 0, "sensor": [0], "exclude": [3], "dir": [0,0,1], "D": 8, "ignore_leaving": true},
                {"id": "down", "scene": 0, "sensor": [0], "exclude": [3], "dir": [0,0,-1], "D": 8, "ignore_leaving": true},
                {"id": "along", "scene": 0, "sensor": [0], "dir": [1,0,0], "D": 8, "ignore_leaving": true, "slack": 1e-12,
                 "skip_overlapping": true, "hits": "all"},
                {"id": "touching", "scene": 0, "sensor": [0], "exclude": [3], "dir": [1,0,0], "D": 8, "hits": 2}]})");
  const char* mode = GENERATE("contact", "reference");
  CAPTURE(mode);
  const Run run = succeed(folder, std::string("query q.json --mode ") + mode);
  const auto lines = linesOf(run.out);
  CHECK(lines[0]["status"] == "clear");
  CHECK(lines[1]["status"] == "overlap");
  CHECK(lines[2]["t"] == 2);
  CHECK(lines[2]["overlapping"] == nlohmann::json::parse("[3]"));
  REQUIRE(lines[2]["hits"].size() == 2);
  CHECK((lines[2]["hits"][0]["object"] == 1 && lines[2]["hits"][0]["t"] == 2));
  CHECK((lines[2]["hits"][1]["object"] == 2 && lines[2]["hits"][1]["t"] == 4));
  CHECK((lines[3]["status"] == "overlap" && lines[3]["object"] == 0));
  CHECK((lines[3]["hits"][0]["t"] == 0 && lines[3]["hits"][1]["object"] == 1));
  CHECK_FALSE(lines[3].contains("overlapping"));

  const Run sampled = runProgram(folder, "query q.json --mode sampled");
  CHECK(sampled.status == 2);
  CHECK_THAT(sampled.err, Contains("--mode: expected contact or reference") && Contains("\"up\""));
}

TEST_CASE("query tells the closest approach and the last contact, and a page shows where") {
  const ScratchFolder folder;
  // In the plane z = 0; a sensor that passes beside it, one that goes through it, and one with nothing around.
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  folder.write("rod.obj", "v 0 0 -1\nv 0 0 1\nv 0.5 0 0\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj", "rod.obj"],
    "scenes": [{"id": "a", "instances": [[0]]}],
    "queries": [{"id": "past", "scene": 0, "sensor": [1, 1,0,0,-9, 0,1,0,-3, 0,0,1,0], "dir": [1,0,0], "D": 20,
                 "closest": true, "exit": true},
                {"id": "through", "scene": 0, "sensor": [1, 1,0,0,1, 0,1,0,1, 0,0,1,0.5], "dir": [0,0,2], "D": 8,
                 "closest": true, "exit": true},
                {"id": "stuck", "scene": 0, "sensor": [1, 1,0,0,1, 0,1,0,1, 0,0,1,0.5], "dir": [0,0,2], "D": 0.25,
                 "exit": true},
                {"id": "alone", "scene": 0, "sensor": [1], "exclude": [0], "dir": [0,0,2], "D": 8, "closest": true}]})");
  const char* mode = GENERATE("contact", "reference");
  CAPTURE(mode);
  const Run run = succeed(folder, std::string("query q.json --out a.jsonl --mode ") + mode);
  const auto lines = linesOf(folder.read("a.jsonl"));
  const nlohmann::json &closest = lines[0]["closest"], &exit = lines[1]["exit"];
  CHECK((closest["distance_lo"] <= 3 && closest["distance_hi"] >= 3 && closest["distance_hi"] < 3 + 1e-12));
  CHECK((closest["object"] == 0 && !closest.contains("lo")));
  CHECK(closest["normal"] == nlohmann::json::parse("[0, -1, 0]"));
  CHECK(lines[0]["exit"].is_null());
  CHECK((lines[1]["closest"]["distance_hi"] == 0 && lines[1]["closest"]["t"] == 0));
  CHECK((exit["lo"] <= 0.5 && exit["t"] == exit["hi"] && exit["hi"] >= 0.5 && exit["hi"] < 0.5 + 1e-14));
  CHECK((exit["feature_a"] == "vertex" && exit["feature_b"] == "face"));
  CHECK((lines[2]["exit"]["lo"] == 0.25 && lines[2]["exit"]["hi"] == 0.25 && !lines[2].contains("closest")));
  CHECK(lines[3]["closest"].is_null());

  succeed(folder, "view q.json a.jsonl --out page.html");
  const nlohmann::json data = pageData(folder.read("page.html"));
  CHECK(data["moments"]["as"] == nlohmann::json({{"u1", "AQECAg=="}}));  // closest, closest, exit, exit
  const Run table = runProgram(folder, "query q.json --out a.csv");
  CHECK(table.status == 2);
  CHECK_THAT(table.err, Contains("\"closest\" or \"exit\" have lists (query \"past\")"));
  const Run sweep = succeed(folder, "sweep a.obj rod.obj --at 1 1 0.5 --direction 0 0 1 --distance 8 --exit --closest");
  CHECK_THAT(sweep.out,
             Contains("nearest 0 to object 0") && Contains("out of  object 0 (a.obj), and of all others, after 0.5"));
}

TEST_CASE("sweep lifts a crate from the floor that it rests on") {
  const ScratchFolder folder;
  folder.write("floor.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  folder.write("crate.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n");
  const std::string sweep = "sweep floor.obj crate.obj --direction 0 0 1 --distance 5";
  CHECK_THAT(runProgram(folder, sweep).out, Contains("overlap"));
  CHECK_THAT(runProgram(folder, sweep + " --ignore-leaving").out, Contains("clear"));
}

TEST_CASE("sweep says that surfaces meet only where nobody has asked for a distance") {
  const ScratchFolder folder;
  folder.write("plate.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n");
  const std::string sweep = "sweep plate.obj plate.obj --mode reference --direction 0 0 1 --distance 5 --at 0 0 ";
  CHECK_THAT(runProgram(folder, sweep + "0").out, Contains("overlap: the surfaces meet at the start already"));
  CHECK_THAT(runProgram(folder, sweep + "0.05 --clearance 0.1").out,
             Contains("overlap: the surfaces are within 0.1 of each other at the start already"));
  CHECK_THAT(runProgram(folder, sweep + "0.2 --clearance 0.1").out,
             Contains("clear: certainly nothing nearer than 0.1 within 5"));
}

TEST_CASE("query answers steps in which objects move and meshes are deformed") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  const float raised[] = {0, 0, 2, 4, 0, 2, 0, 4, 2};
  folder.write("raised.f32", std::string(reinterpret_cast<const char*>(raised), sizeof raised));
  // Its object comes down by 4 of 10 while the sensor, which is deformed in the second scene, goes up by 12.
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj", "a.obj"],
    "scenes": [{"id": "a", "instances": [[0, 1,0,0,0, 0,1,0,0, 0,0,1,8]], "motions": [[0, 0,0,-4]]},
               {"id": "b", "base": 0, "instances": [], "deforms": [[1, "raised.f32"]]}],
    "queries": [{"id": "step", "scene": 0, "sensor": [1], "motion": [0,0,12], "speed": 4},
                {"id": "rest", "scene": 0, "sensor": [1, 1,0,0,0, 0,1,0,0, 0,0,1,6], "motion": [0,0,0]},
                {"id": "sweep", "scene": 0, "sensor": [1], "dir": [0,0,1], "D": 12},
                {"id": "raised", "scene": 1, "sensor": [1], "dir": [0,0,1], "D": 12}]})");
  const char* mode = GENERATE("contact", "reference");
  CAPTURE(mode);
  const Run run = succeed(folder, std::string("query q.json --mode ") + mode);
  const auto lines = linesOf(run.out);
  CHECK((lines[0]["t"] == 6 && lines[0]["fraction"] == 0.5 && lines[0]["time"] == 1.5));
  CHECK((lines[0]["fraction_lo"] <= 0.5 && lines[0]["fraction_hi"] >= 0.5 && lines[0]["point"][2] == 6));
  CHECK((lines[1]["t"] == 0 && lines[1]["fraction"] == 0.5 && lines[1]["status"] == "hit"));
  CHECK((lines[2]["t"] == 6 && lines[2]["fraction"] == 0.5 && !lines[2].contains("fraction_lo")));
  CHECK((lines[3]["t"] == 6 && lines[3]["fraction"] == 0.5));
}

TEST_CASE("a query that turns is answered with a bracket of the step, shown on a page, and refused by scopes") {
  const ScratchFolder folder;
  folder.write("a.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n");
  // The triangle opens like a lid, up to another one at the height of half its length.
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["a.obj"],
    "scenes": [{"id": "a", "instances": [[0, 1,0,0,-0.5, 0,1,0,0, 0,0,1,2]]}],
    "queries": [{"id": "lid", "scene": 0, "sensor": [0],
                 "turn": {"axis": [3, 0, 0], "angle": 1.5707963267948966, "centre": [9, 0, 0]}},
                {"id": "away", "scene": 0, "sensor": [0], "motion": [0, 0, -1],
                 "turn": {"axis": [1, 0, 0], "angle": -1, "centre": [0, 0, 0]}}]})");
  const char* mode = GENERATE("contact", "reference");
  const Run run = succeed(folder, std::string("query q.json --out a.jsonl --mode ") + mode);
  const auto lines = linesOf(folder.read("a.jsonl"));
  CHECK((lines[0]["status"] == "hit" && lines[0]["t"] == lines[0]["fraction_lo"]));
  CHECK((lines[0]["fraction_lo"] <= 1 / 3.0 + 1e-9 && lines[0]["fraction_hi"] >= 1 / 3.0 - 1e-9));
  CHECK(double(lines[0]["fraction_hi"]) - double(lines[0]["fraction_lo"]) < 1e-6);
  CHECK((lines[1]["status"] == "clear"));
  succeed(folder, "query q.json --check");
  succeed(folder, "view q.json a.jsonl --out v.html --gltf v.glb");
  const auto queries = pageData(folder.read("v.html"))["queries"];
  CHECK(queries["turns"]["1"] == nlohmann::json::parse(R"({"axis": [1, 0, 0], "angle": -1, "centre": [0, 0, 0]})"));
  CHECK(queries["turns"].size() == 2);
  CHECK(queries["step"]["u1"] == "AQE=");  // 1, 1
  CHECK_THAT(folder.read("v.glb"), Contains("\"rotation\""));
  const Run refused = runProgram(folder, "scopes q.json --query lid --out s");
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("expected a straight motion, along which scopes look, got a turn"));
}
