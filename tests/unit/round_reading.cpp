// Round sensors and cutters in query files.
#include "query_texts.h"

using namespace radar;
using namespace radar::test;
using namespace radar::tools;

TEST_CASE("cutters have their kind's numbers, and a holder above") {
  Files files;
  nlohmann::json file = goodFile();
  file["meshes"] = nlohmann::json::parse(R"(["a.obj",
    {"shape": "bull_nose", "radius": 3, "corner": 1, "length": 20, "holder": [[[20, 5], [30, 8, 0.5]]]},
    {"shape": "cone", "radius": 3, "angle": 0.5, "length": 20},
    {"shape": "taper", "radius": 3, "angle": 0.25, "tip_radius": 1, "length": 20}])");
  const Workload workload = files.read(file.dump());
  CHECK(workload.meshes[0].cutter.parts.empty());
  const Cutter& tool = workload.meshes[1].cutter;
  REQUIRE(tool.parts.size() == 2);
  CHECK(tool.parts[0][0].radius == 2);
  CHECK(tool.parts[1][1].corner == 0.5);
  CHECK(workload.meshes[1].triangleCount() > 100);
  CHECK(workload.meshes[2].cutter.parts[0][0].radius == 0);
  CHECK(workload.meshes[3].cutter.parts[0][0].corner == 1);
  file["scenes"][0]["instances"].push_back({1});
  CHECK_THAT(files.refusal(file.dump()), Contains("scenes[0]: instance 2: mesh 1: expected a mesh, got a cutter"));
}

TEST_CASE("what a cutter cannot do, and closest and exit with a turn or ignore_leaving, is refused by its key") {
  Files files;
  nlohmann::json file = goodFile();
  file["meshes"] = nlohmann::json::parse(R"(["a.obj", {"shape": "flat", "radius": 3, "length": 20}])");
  file["queries"].erase(1);
  const auto refusal = [&](uint32_t mesh, const char* more) {
    nlohmann::json changed = file;
    changed["queries"][0]["sensor"] = {mesh};
    changed["queries"][0].update(nlohmann::json::parse(more));
    if (changed["queries"][0].contains("turn")) {
      for (const char* straight : {"dir", "D", "speed"}) changed["queries"][0].erase(straight);
    }
    return files.refusal(changed.dump());
  };
  const char* const turn = R"({"turn": {"axis": [0, 0, 1], "angle": 1, "centre": [0, 0, 0]}, "exit": true})";
  CHECK_THAT(refusal(0, turn), StartsWith("queries[0].exit: expected none beside a turn"));
  CHECK_THAT(refusal(1, turn), StartsWith("queries[0].turn: expected none with a cutter"));
  for (const std::string key : {"closest", "exit"}) {
    CHECK_THAT(refusal(0, ("{\"ignore_leaving\": true, \"" + key + "\": true}").c_str()),
               StartsWith("queries[0]." + key + ": expected none beside \"ignore_leaving\""));
  }
  for (const std::string key : {"closest", "exit", "ignore_leaving", "skip_overlapping"}) {
    CHECK_THAT(refusal(1, ("{\"" + key + "\": true}").c_str()),
               StartsWith("queries[0]." + key + ": expected none with a cutter"));
  }
  CHECK_THAT(refusal(1, R"({"mode": "sampled"})"),
             StartsWith("queries[0].mode: expected contact or reference, as a cutter needs"));
}

TEST_CASE("no link of a chain is round or a cutter") {
  Files files;
  nlohmann::json file = goodFile();
  file["meshes"] = nlohmann::json::parse(
      R"(["a.obj", {"shape": "ball", "radius": 2}, {"shape": "flat", "radius": 3, "length": 20}])");
  file["chains"] = nlohmann::json::parse(R"([{"links": [{"name": "arm", "meshes": [[0], [1]]}]}])");
  CHECK_THAT(files.refusal(file.dump()),
             StartsWith("chains[0].links[0].meshes[1][0]: expected a mesh without a radius, which only sensors have"));
  file["chains"][0]["links"][0]["meshes"][1] = {2};
  CHECK_THAT(files.refusal(file.dump()), StartsWith("chains[0].links[0].meshes[1][0]: expected a mesh, got a cutter"));
}

TEST_CASE("round sensors have their radius beside the clearance of a query") {
  Files files;
  nlohmann::json file = goodFile();
  file["meshes"] = nlohmann::json::parse(R"(["a.obj", {"shape": "ball", "radius": 2}, {"file": "a.obj", "radius": 0.5},
    {"shape": "capsule", "from": [1, 0, 0], "to": [5e6, 0, 0.1], "radius": 0.25}])");
  file["queries"].erase(1);
  for (int mesh = 1; mesh < 4; ++mesh) {
    nlohmann::json query = file["queries"][0];
    query["id"] = std::to_string(mesh);
    query["sensor"] = {mesh};
    if (mesh == 2) query["clearance"] = 0.125;
    file["queries"].push_back(query);
  }
  const Workload workload = files.read(file.dump());
  CHECK(workload.queries[0].clearance == 0);
  CHECK(workload.queries[1].clearance == 2);
  CHECK(workload.queries[2].clearance == 0.625);
  CHECK(workload.queries[3].clearance == 0.25);
  CHECK(workload.meshes[1].indices == std::vector<uint32_t>{0, 0, 0});
  CHECK(workload.meshes[2].triangleCount() == 1);
  CHECK(workload.meshes[3].indices == std::vector<uint32_t>{0, 1, 1});
  for (size_t end = 0; end < 2; ++end) {
    const auto at = transformPoint(workload.queries[3].worldFromMesh, &workload.meshes[3].positions[3 * end]);
    CHECK(std::abs(at[0] - (end == 0 ? 1 : 5e6)) < 1);
  }
  // Likewise in arrays.
  const std::filesystem::path folder = files.folder.path() / "arrays";
  std::vector<std::string> warnings;
  const std::string written = writeQueryFile(workload, folder, true).string();
  nlohmann::json arrays = nlohmann::json::parse(files.folder.read("arrays/queries.json"));
  arrays["meshes"][0] = {{"file", "mesh-0.ply"}, {"radius", 8}};
  arrays["scenes"][0]["instances"] = {{3}};
  arrays["scenes"][1]["instances"] = {{3}};
  files.folder.write("arrays/queries.json", arrays.dump());
  const Workload again = QueryFile(written, warnings).all();
  CHECK(again.queries[0].clearance == 8);
  CHECK(again.queries[2].clearance == 0.625);
  file["queries"][1]["mode"] = "sampled";
  CHECK_THAT(files.refusal(file.dump()), StartsWith("queries[1].mode: expected contact or reference"));
}

TEST_CASE("a shape that breaks its contract is refused with its path, what was expected and what was found") {
  Files files;
  const struct {
    const char *mesh, *path, *problem;
  } cases[] = {
      {R"({"shape": "ball", "radius": -1})", "meshes[0].radius: ", "from 0 to 2^1000, got -1"},
      {R"({"shape": "ball"})", "meshes[0]: ", "\"radius\", which is missing"},
      {R"({"shape": "ball", "radius": 1, "from": []})", "meshes[0].from: ", "keys shape, radius"},
      {R"({"shape": "torus", "radius": 1})", "meshes[0].shape: ", "\"cone\" or \"taper\", got \"torus\""},
      {R"({"shape": "flat", "radius": 1})", "meshes[0]: ", "\"length\", which is missing"},
      {R"({"shape": "flat", "radius": 1, "length": 9, "corner": 1})",
       "meshes[0]: ", "\"corner\": expected none in a flat"},
      {R"({"shape": "ball_cutter", "radius": 2, "length": 1})",
       "meshes[0].length: ", "expected at least twice the radius"},
      {R"({"shape": "cone", "radius": 1, "angle": 0.5, "length": 9, "tip_radius": 1})",
       "meshes[0].tip_radius: ", "expected 0 or more, less than the radius, got 1"},
      {R"({"shape": "taper", "radius": 1, "angle": 2, "length": 9, "tip_radius": 0.5})",
       "meshes[0].angle: ", "expected radians between 0 and pi/2, got 2"},
      {R"({"shape": "flat", "radius": 2, "length": 1, "holder": [[[1, 2], [3, -1]]]})",
       "meshes[0].holder[0][1]: ", "radius: expected 0 to 2^100, got -1"},
      {R"({"shape": "flat", "radius": 2, "length": 1, "holder": [[[1, 2], [2, 2]], []]})",
       "meshes[0].holder[1]: ", "expected rings that span a solid"},
      {R"({"shape": "flat", "radius": 2, "length": 1, "holder": [[[1]]]})",
       "meshes[0].holder[0][0]: ", "2 or 3 numbers"},
      {R"({"shape": "capsule", "from": [0,0,0], "to": [0,1e39,0], "radius": 1})", "meshes[0].to[1]: ", "floats hold"},
      {R"({"shape": "capsule", "from": [0,0], "to": [0,1,0], "radius": 1})", "meshes[0].from: ", "3 numbers"},
      {R"({"file": "a.obj", "radius": "2"})", "meshes[0].radius: ", "a finite number"},
      {R"({"file": "a.obj", "radius": 2})", "scenes[0]: ", "instance 0: mesh 0: expected a mesh without a radius"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.mesh);
    CHECK_THAT(files.refusalWith("/meshes/0", c.mesh), StartsWith(c.path) && Contains(c.problem));
  }
}
