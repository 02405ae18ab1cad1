// Motions, deformations and turns in query files.
#include <nlohmann/json.hpp>
#include <span>

#include "query_texts.h"

using namespace radar;
using namespace radar::test;
using namespace radar::tools;

TEST_CASE("motions and deformations are read, written as they were read, and refused by their place") {
  Files files;
  const std::vector<float> positions{0, 0, 1, 2, 0, 0, 0, 2, 0.5};
  const auto bytes = [](std::span<const float> values) {
    return std::string(reinterpret_cast<const char*>(values.data()), values.size_bytes());
  };
  files.folder.write("a.f32", bytes(positions));
  files.folder.write("short.f32", "12345");
  files.folder.write("bad.f32", bytes(std::vector<float>{0, 0, 1, 2, NAN, 0, 0, 2, 0}));
  nlohmann::json file = goodFile();
  file["scenes"][1]["motions"] = nlohmann::json::parse("[[2, 0, 0.5, 0], [0, 1, 2, 3]]");
  file["scenes"][1]["deforms"] = nlohmann::json::parse(R"([[0, "a.f32"]])");
  file["queries"][0].erase("dir");
  file["queries"][0].erase("D");
  file["queries"][0]["motion"] = nlohmann::json::parse("[0, -1, 1e-3]");
  file["queries"][0]["turn"] = nlohmann::json::parse(R"({"axis": [0, 2, 0.5], "angle": -3.5, "centre": [1, 2, 1e9]})");
  file["queries"][1]["mode"] = "reference";
  const Workload workload = files.read(file.dump());
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, files.folder.path() / "again"), warnings).all();
  for (const Workload& one : {workload, again}) {
    CHECK(one.scenes[0].motions.empty());
    CHECK(one.scenes[1].motions == std::vector<ObjectMotion>{{2, {0, 0.5, 0}}, {0, {1, 2, 3}}});
    REQUIRE(one.scenes[1].deforms.size() == 1);
    CHECK(one.scenes[1].deforms[0].positions == positions);
    CHECK(one.queries[0].motion == std::array<double, 3>{0, -1, 1e-3});
    CHECK_FALSE(one.queries[1].motion);
    REQUIRE(one.queries[0].turn);
    CHECK(one.queries[0].turn->axis == std::array<double, 3>{0, 2, 0.5});
    CHECK(one.queries[0].turn->angle == -3.5);
    CHECK(one.queries[0].turn->centre == std::array<double, 3>{1, 2, 1e9});
    CHECK_FALSE(one.queries[1].turn);
  }
  const auto refused = [&](const char* pointer, const char* value) {
    nlohmann::json changed = file;
    changed[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    return files.refusal(changed.dump());
  };
  for (const auto& [pointer, value, path, problem] : std::initializer_list<std::array<const char*, 4>>{
           {"/scenes/1/motions/0", "[3, 0, 0, 0]", "scenes[1].motions[0][0]: ", ""},
           {"/scenes/1/motions/0", "[0, 0, 0, 0]", "scenes[1].motions", "each object once"},
           {"/scenes/1/motions/0", "[2, 0, 0]", "scenes[1].motions[0]: ", "[object, dx, dy, dz]"},
           {"/scenes/1/motions/0", "[2, 0, 0, -1e305]", "scenes[1].motions[0][3]: ", ""},
           {"/scenes/1/deforms/0", R"([1, "a.f32"])", "scenes[1].deforms[0][0]: ", ""},
           {"/scenes/1/deforms/0/1", R"("short.f32")", "scenes[1].deforms[0]", "expected 36 bytes"},
           {"/scenes/1/deforms/0/1", R"("bad.f32")", "scenes[1].deforms[0]", "vertex 1: expected finite numbers"},
           {"/scenes/1/deforms/0/1", R"("none.f32")", "scenes[1].deforms[0]", "no such file"},
           {"/queries/0/D", "2", "queries[0].D: ", "got both"},
           {"/queries/0/motion", "[1, 2]", "queries[0].motion: ", ""},
           {"/queries/0/turn", R"({"axis": [0, 0, 1], "angle": 1})", "queries[0].turn: ", "centre"},
           {"/queries/0/turn/axis", "[0, 1]", "queries[0].turn.axis: ", "3"},
           {"/queries/0/turn/pitch", "1", "queries[0].turn.pitch: ", "angle"},
           {"/queries/0/turn/axis", "[0, 0, 0]", "queries[0].turn.axis: ", "not zero"},
           {"/queries/0/turn/angle", "7e4", "queries[0].turn.angle: ", "2^16"},
           {"/queries/0/turn/centre", "[0, 1e300, 0]", "queries[0].turn.centre[1]: ", "2^800"},
           {"/queries/0/motion", "[0, 0, 1e250]", "queries[0].motion[2]: ", "2^800 beside \"turn\""},
           {"/queries/0/speed", "2", "queries[0].speed: ", "turn"},
           {"/queries/0/motion", "[0, 1e305, 0]", "queries[0].motion[1]: ", "2^1000"},
           {"/queries/1/D", "1e305", "queries[1].D: ", ""},
           {"/queries/1/mode", R"("sampled")", "queries[1].mode: ", "\"motions\" needs"}}) {
    CAPTURE(pointer, value);
    CHECK_THAT(refused(pointer, value), StartsWith(path) && Contains(problem));
  }
}

TEST_CASE("a turn to a pose is about a point of the mesh, or the middle of its box, or is refused") {
  Files files;
  // Far from the origin, so that the mesh is about a base.
  files.folder.write("far.obj", "v 4512350 0 0\nv 4512350.5 0 0\nv 4512350 1 0.25\nf 1 2 3\n");
  nlohmann::json file = goodFile();
  file["meshes"] = {"far.obj"};
  file["queries"] = nlohmann::json::parse(R"([{"id": "p", "scene": 0, "sensor": [0, 1,0,0,-4512350, 0,1,0,0, 0,0,1,0],
    "turn": {"to": [0,-1,0,2, 1,0,0,-4512350, 0,0,1,0]}}])");
  const auto turnOf = [&](const nlohmann::json& text) {
    const QuerySpec query = files.read(text.dump()).queries.at(0);
    REQUIRE((query.turn && query.motion));
    CHECK(query.turn->angle == Approx(0.5 * 3.14159265358979));
    CHECK(query.turn->axis[2] > 0.5);
    return std::pair(query.turn->centre, *query.motion);
  };
  const std::array<double, 3> middle{0.25, 0.5, 0.125}, way{2 - 0.5 - 0.25, 0.25 - 0.5, 0};
  CHECK(turnOf(file) == std::pair(middle, way));
  file["queries"][0]["turn"]["about"] = {4512350, 1, 0};
  CHECK(turnOf(file) == std::pair(std::array<double, 3>{0, 1, 0}, std::array<double, 3>{1, -1, 0}));
  const auto refused = [&](const char* pointer, const char* value) {
    nlohmann::json changed = file;
    changed[nlohmann::json::json_pointer(pointer)] = nlohmann::json::parse(value);
    return files.refusal(changed.dump());
  };
  for (const auto& [pointer, value, words] : std::initializer_list<std::array<const char*, 3>>{
           {"/queries/0/turn/to", "[0, 1]", "queries[0].turn.to: expected 12 numbers"},
           {"/queries/0/turn/to", "[1,0,0,0, 1,0,0,0, 0,0,1,0]", "queries[0].turn.to: expected"},
           {"/queries/0/turn/to", "[-1,0,0,0, 0,-1,0,0, 0,0,1,0]", "queries[0].turn: expected less than half a turn"},
           {"/queries/0/turn/to", "[2,0,0,0, 0,2,0,0, 0,0,2,0]", "queries[0].turn: expected an end that is the start"},
           {"/queries/0/turn/about", "[0, 1]", "queries[0].turn.about: expected 3 numbers"},
           {"/queries/0/turn/about", "[0, 1, 1e300]", "queries[0].turn: about: expected"},
           {"/queries/0/turn/angle", "1", "queries[0].turn.angle: expected one of the keys to, about"},
           {"/queries/0/motion", "[0, 0, 1]", "queries[0].motion: expected none beside a turn to a pose"}}) {
    CAPTURE(pointer, value);
    CHECK_THAT(refused(pointer, value), StartsWith(words));
  }
}

TEST_CASE("turns are written as columns of an array, and read as they were") {
  Files files;
  nlohmann::json file = goodFile();
  for (nlohmann::json& query : file["queries"]) {
    for (const char* straight : {"dir", "D", "speed", "mode"}) query.erase(straight);
  }
  file["queries"][0]["turn"] = nlohmann::json::parse(R"({"axis": [0, 2, 0.5], "angle": -3.5, "centre": [1, 2, 1e9]})");
  for (const char* other :
       {R"({"turn": {"axis": [0, 0, 0], "angle": 0, "centre": [0, 0, 3]}})", R"({"motion": [0, 0, 1]})"}) {
    for (size_t i = 1; i < file["queries"].size(); ++i) file["queries"][i].merge_patch(nlohmann::json::parse(other));
    const Workload workload = files.read(file.dump());
    std::vector<std::string> warnings;
    const Workload again = QueryFile(writeQueryFile(workload, files.folder.path() / "again", true), warnings).all();
    REQUIRE(again.queries.size() == workload.queries.size());
    for (size_t i = 0; i < workload.queries.size(); ++i) {
      const QuerySpec &given = workload.queries[i], &read = again.queries[i];
      const std::array<double, 3> rest{};
      CHECK(read.motion.value_or(rest) == given.motion.value_or(rest));
      REQUIRE(read.turn.has_value() == given.turn.has_value());
      if (!given.turn) continue;
      CHECK(read.turn->axis == given.turn->axis);
      CHECK(read.turn->angle == given.turn->angle);
      CHECK(read.turn->centre == given.turn->centre);
    }
    for (size_t i = 1; i < file["queries"].size(); ++i) file["queries"][i].erase("turn");
  }
}
