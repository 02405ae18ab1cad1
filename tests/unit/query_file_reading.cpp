#include <nlohmann/json.hpp>
#include <span>

#include "batch/binary_queries.h"
#include "batch/query_file.h"
#include "query_texts.h"
#include "workloads/generate.h"

using namespace radar;
using namespace radar::test;
using namespace radar::tools;

TEST_CASE("all values of a query file are read") {
  Files files;
  const Workload workload = files.read(goodFile().dump());
  REQUIRE(workload.meshes.size() == 1);
  CHECK(workload.meshes[0].triangleCount() == 1);
  REQUIRE(workload.scenes.size() == 2);
  CHECK(workload.scenes[0].instances[1].worldFromMesh.m[3] == 5);
  CHECK(workload.scenes[1].base == 0u);
  CHECK(workload.objectCount(1) == 3);
  CHECK(workload.scenes[1].masks == std::vector<ObjectMask>{{1, 6}});
  REQUIRE(workload.queries.size() == 2);
  const QuerySpec &plain = workload.queries[0], &full = workload.queries[1];
  CHECK(plain.id == "p");
  CHECK(plain.batch == 0);
  CHECK(plain.mask == ~0u);
  CHECK_FALSE(plain.mode);
  CHECK_FALSE(plain.speed);
  CHECK_FALSE(plain.anyHit);
  CHECK_FALSE(plain.tolerance);
  CHECK(full.batch == 3);
  CHECK(full.exclude == std::vector<uint32_t>{2});
  CHECK(full.direction == std::array<double, 3>{0, -0.5, 1});
  CHECK(full.distance == 0);
  CHECK(full.mask == 5);
  CHECK(full.mode == AnswerMode::sampled);
  CHECK(full.speed == 2.5);
  CHECK(full.anyHit);
  CHECK(full.tolerance == 0.25);
  CHECK(full.worldFromMesh.m[11] == -2);
}

TEST_CASE("a value that breaks its contract is refused with its path, what was expected and what was found") {
  Files files;
  const struct {
    const char *pointer, *value, *path, *problem;
  } cases[] = {
      {"/format", "\"cyber-radar-queries-2\"", "format: ", "got \"cyber-radar-queries-2\""},
      {"/meshes", "{}", "meshes: ", "an array"},
      {"/meshes/0", "3", "meshes[0]: ", "a string"},
      {"/meshes/0", "\"no.obj\"", "meshes[0]: ", "no such file"},
      {"/scenes/0", "[]", "scenes[0]: ", "an object"},
      {"/scenes/1/id", "\"a\"", "scenes[1].id: ", "no other scene"},
      {"/scenes/1/base", "1", "scenes[1].base: ", "scenes before this one"},
      {"/scenes/1/base", "-1", "scenes[1].base: ", "got -1"},
      {"/scenes/1/instances/0/0", "1", "scenes[1].instances[0][0]: ", "one of the 1 meshes"},
      {"/scenes/1/instances/0/0", "0.5", "scenes[1].instances[0][0]: ", "a whole number"},
      {"/scenes/1/instances/0/4", "\"x\"", "scenes[1].instances[0][4]: ", "a finite number"},
      {"/scenes/1/instances/0/4", "null", "scenes[1].instances[0][4]: ", "got null"},
      {"/scenes/1/instances/0", "[0, 1]", "scenes[1].instances[0]: ", "12 numbers"},
      {"/scenes/1/instances/0", "[0, 1,0,0,0, 0,0,0,0, 0,0,1,0]", "scenes[1].instances[0]: ", "zero column"},
      {"/scenes/1/instances/0", "[0, 1,2,3,0, 2,4,6,0, 0,0,1,0]", "scenes[1].instances[0]: ", "singular"},
      {"/scenes/1/masks/0/0", "3", "scenes[1].masks[0][0]: ", "one of the 3 objects"},
      {"/scenes/1/masks/0/1", "4294967296", "scenes[1].masks[0][1]: ", "4294967295"},
      {"/scenes/1/masks", "[[1,2],[1,3]]", "scenes[1].masks[1][0]: ", "each object once"},
      {"/queries/1/id", "7", "queries[1].id: ", "a string"},
      {"/queries/1/id", "\"p\"", "queries[1].id: ", "no other query"},
      {"/queries/1/scene", "2", "queries[1].scene: ", "one of the 2 scenes"},
      {"/queries/1/batch", "-1", "queries[1].batch: ", "a whole number"},
      {"/queries/1/sensor/0", "9", "queries[1].sensor[0]: ", "got 9"},
      {"/queries/1/sensor/4", "true", "queries[1].sensor[4]: ", "got true"},
      {"/queries/1/sensor", "[0, 0,0,0,0, 0,1,0,0, 0,0,1,0]", "queries[1].sensor: ", "invertible"},
      {"/queries/1/exclude/0", "3", "queries[1].exclude[0]: ", "one of the 3 objects"},
      {"/queries/0/exclude", "[2]", "queries[0].exclude[0]: ", "one of the 2 objects"},
      {"/queries/1/dir", "[0, 0, 0]", "queries[1].dir: ", "not zero"},
      {"/queries/1/dir", "[0, 1]", "queries[1].dir: ", "3 numbers"},
      {"/queries/1/D", "-1e-9", "queries[1].D: ", "0 or more"},
      {"/queries/1/D", "\"8\"", "queries[1].D: ", "got \"8\""},
      {"/queries/1/mask", "1.5", "queries[1].mask: ", "a whole number"},
      {"/queries/1/mode", "\"fast\"", "queries[1].mode: ", "got \"fast\""},
      {"/queries/1/mode", "\"bounded\"", "queries[1].mode: ", "sampled, contact or reference, got \"bounded\""},
      {"/queries/1/any_hit", "1", "queries[1].any_hit: ", "true or false"},
      {"/queries/1/tolerance", "-1", "queries[1].tolerance: ", "a finite number of 0 or more"},
      {"/queries/1/tolerance", "null", "queries[1].tolerance: ", "a finite number"},
      {"/queries/1/speed", "0", "queries[1].speed: ", "above 0"},
      {"/queries/0/ignore_leaving", "1", "queries[0].ignore_leaving: ", "true or false"},
      {"/queries/0/skip_overlapping", "\"yes\"", "queries[0].skip_overlapping: ", "true or false"},
      {"/queries/0/slack", "-1e-12", "queries[0].slack: ", "a finite number of 0 or more"},
      {"/queries/0/hits", "0", "queries[0].hits: ", "from 1 to 4294967294, or \"all\", got 0"},
      {"/queries/0/hits", "1e300", "queries[0].hits: ", "or \"all\""},
      {"/queries/0/hits", "\"some\"", "queries[0].hits: ", "or \"all\""},
      {"/queries/1/hits", "2", "queries[1].hits: ", "1 beside \"any_hit\""},
      {"/queries/1/ignore_leaving", "true", "queries[1].mode: ", "contact or reference, as \"ignore_leaving\" needs"},
      {"/queries/0/clearance", "-1", "queries[0].clearance: ", "a finite number of 0 or more"},
      {"/queries/1/clearance", "1", "queries[1].mode: ", "contact or reference"},
      // Keys that are unknown, and reserved ones.
      {"/extra", "1", "extra: ", "got \"extra\""},
      {"/scenes/0/Instances", "[]", "scenes[0].Instances: ", "got \"Instances\""},
      {"/queries/1/direction", "[]", "queries[1].direction: ", "got \"direction\""},
      {"/queries/1/rotation", "0", "queries[1].rotation", "\"rotation\", which is reserved for a later version"},
      {"/scenes/2", R"({"id": "c", "base": 1, "instances": []})", "scenes[2].base: ", "no base"},
  };
  for (const auto& c : cases) {
    CAPTURE(c.pointer, c.value);
    CHECK_THAT(files.refusalWith(c.pointer, c.value), StartsWith(c.path) && Contains(c.problem));
  }
}

TEST_CASE("a query's mode may be sampled, contact or reference") {
  Files files;
  for (const auto& [name, mode] : {std::pair{"sampled", AnswerMode::sampled}, std::pair{"contact", AnswerMode::contact},
                                   std::pair{"reference", AnswerMode::reference}}) {
    nlohmann::json file = goodFile();
    file["queries"][1]["mode"] = name;
    CHECK(files.read(file.dump()).queries[1].mode == mode);
  }
}

TEST_CASE("the message about a missing key names it") {
  Files files;
  for (const char* pointer : {"/format", "/meshes", "/scenes", "/queries"}) {
    nlohmann::json file = goodFile();
    file.erase(pointer + 1);
    CHECK_THAT(files.refusal(file.dump()), Contains("\"" + std::string(pointer + 1) + "\", which is missing"));
  }
  for (const char* key : {"id", "scene", "sensor", "dir", "D"}) {
    nlohmann::json file = goodFile();
    file["queries"][1].erase(key);
    CHECK_THAT(files.refusal(file.dump()), StartsWith("queries[1]: ") && Contains(key));
  }
}

TEST_CASE("a scene may be an assembly, alone or upon a base, and a mesh may be one of its nodes") {
  Files files;
  files.folder.write("b.obj", std::string(kMesh) + "o lid\nf 1 3 2\no box\nf 3 2 1\nf 1 2 3\n");
  nlohmann::json file = goodFile();
  file["meshes"] = {"a.obj", "b.obj#lid"};
  file["scenes"][1] = {{"id", "b"}, {"base", 0}, {"assembly", "b.obj"}, {"masks", {{4, 6}}}};
  file["scenes"].push_back({{"id", "c"}, {"assembly", "b.obj"}});
  file["queries"][0].update({{"scene", 2}, {"sensor", {1}}, {"exclude", {1}}});
  const Workload workload = files.read(file.dump());
  REQUIRE(workload.meshes.size() == 5);
  CHECK(workload.meshes[1].name == "b.obj#lid");
  CHECK(workload.meshes[1].indices == workload.meshes[3].indices);
  REQUIRE(workload.objectCount(1) == 5);
  REQUIRE(workload.objectCount(2) == 3);
  CHECK(workload.instance(1, 4) == Instance{4, {}});
  CHECK(workload.instance(2, 2) == Instance{4, {}});
  CHECK(workload.objectNames(0).empty());
  CHECK(workload.objectNames(1).size() == 5);
  CHECK((workload.objectNames(1)[1].empty() && workload.objectNames(1)[3] == "lid"));
  CHECK(workload.objectNames(2)[2] == "box");

  file["scenes"][2]["instances"] = nlohmann::json::array();
  CHECK_THAT(files.refusal(file.dump()), StartsWith("scenes[2]: ") && Contains("only one of"));
  file["scenes"][2] = {{"id", "c"}, {"assembly", "no.glb"}};
  CHECK_THAT(files.refusal(file.dump()), StartsWith("scenes[2].assembly: ") && Contains("no such file"));
  file["scenes"][2] = {{"id", "c"}, {"assembly", "b.obj"}};
  file["queries"][0]["sensor"] = {2};
  CHECK_THAT(files.refusal(file.dump()), StartsWith("queries[0].sensor[0]: ") && Contains("one of the 2 meshes"));
  file["meshes"][1] = "b.obj#roof";
  CHECK_THAT(files.refusal(file.dump()), StartsWith("meshes[1]: ") && Contains("b.obj#roof: expected the name"));
}

TEST_CASE("text that is not JSON is refused with line, column and path") {
  Files files;
  const std::string text = goodFile().dump(1);
  CHECK_THAT(files.refusal(text.substr(0, text.size() / 2)), Contains("at line ") && Contains("unexpected end"));
  CHECK_THAT(files.refusal(text + "x"), Contains("column 2"));
  CHECK_THAT(files.refusal(""), Contains("at line 1"));
  CHECK_THAT(files.refusal("{\"meshes\": [\"a\", NaN]}"), StartsWith("meshes[1]: ") && Contains("at line 1"));
  CHECK_THAT(files.refusal("{\"queries\": [{\"D\": 1e400}]}"), StartsWith("queries[0].D: ") && Contains("1e400"));
  CHECK_THAT(files.refusal("{\"queries\": [{}, {\"D\": 1, \"D\": 2}]}"),
             StartsWith("queries[1]") && Contains("\"D\" twice"));
  CHECK_THAT(files.refusal("{\"format\": \"\xff\"}"), StartsWith("format: ") && Contains("at line 1"));
  CHECK_THAT(files.refusal(std::string(200'000, '[')), StartsWith("expected at most 100 levels"));
}

TEST_CASE("an instance file is an array of meshes and poses, and the message about a bad row gives its number") {
  Files files;
  nlohmann::json file = goodFile();
  file["scenes"][0] = {{"id", "a"}, {"instances_file", "a.npy"}};
  const std::string text = file.dump();
  const std::array<Instance, 2> good{Instance{}, {0, {{1, 0, 0, 0.1, 0, 1, 0, 0, 0, 0, 1, -2e-3}}}};
  const auto refused = [&](const std::vector<Instance>& rows) {
    writePlaced(rows, files.folder.path() / "a.npy");
    return files.refusal(text);
  };
  writePlaced(good, files.folder.path() / "a.npy");
  CHECK(std::ranges::equal(files.read(text).scenes[0].instances, good));
  const std::string bytes = files.folder.read("a.npy"), place = "scenes[0].instances_file: ";
  CHECK_THAT(refused({good[0], {1, {}}}),
             StartsWith(place) && Contains("a.npy: mesh[1]: expected a whole number that names one of the 1 meshes"));
  CHECK_THAT(refused({{0, {{1, 0, 0, HUGE_VAL, 0, 1, 0, 0, 0, 0, 1, 0}}}}), StartsWith(place) && Contains("pose[0]: "));
  CHECK_THAT(refused({{0, {{0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}}}}), Contains("pose[0]: expected an invertible"));
  const auto refusedBytes = [&](const std::string& content) {
    files.folder.write("a.npy", content);
    return files.refusal(text);
  };
  // As instance files were before.
  CHECK_THAT(refusedBytes("0 1 0 0 0.1 0 1 0 0 0 0 1 -2e-3\n0\n"),
             StartsWith(place) && Contains("a.npy: expected an array in numpy's format .npy"));
  CHECK_THAT(refusedBytes(""), StartsWith(place) && Contains("expected an array"));
  CHECK_THAT(refusedBytes(bytes + "0"), Contains("expected 2 rows of 100 bytes, got 201 bytes"));
  std::string renamed = bytes;
  renamed.replace(renamed.find("pose"), 4, "Pose");
  CHECK_THAT(refusedBytes(renamed), Contains("pose: expected this column, which is missing"));
  CHECK_THAT(refusedBytes(npyHeader("[('mesh', '|u1'), ('pose', '<f8', (3, 4)), ('mask', '<u4')]", 0)),
             Contains("mask: expected one of the columns mesh, pose"));
  std::filesystem::remove(files.folder.path() / "a.npy");
  CHECK_THAT(files.refusal(text), StartsWith(place) && Contains("a.npy"));
}

TEST_CASE("a fingerprint tells files apart that have other answers, and no two forms of a mesh") {
  Files files;
  nlohmann::json file = goodFile();
  file["scenes"][0] = {{"instances_file", "a.npy"}, {"deforms", {{0, "p.f32"}}}};
  file["scenes"].push_back({{"assembly", "b.obj"}});
  const auto write = [&](const std::string& mesh, double x, const std::string& positions, const std::string& assembly) {
    files.folder.write("a.obj", mesh);
    writePlaced(std::vector<Instance>{{0, {{1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0}}}, {}}, files.folder.path() / "a.npy");
    files.folder.write("p.f32", positions);
    files.folder.write("b.obj", assembly);
  };
  const auto fingerprint = [&] {
    std::vector<std::string> warnings;
    return QueryFile(files.folder.write("q.json", file.dump()), warnings).fingerprint();
  };
  const std::string mesh = kMesh, zeros(36, 0), parts = mesh + "o lid\nf 1 3 2\n";
  std::string moved = zeros;
  moved[0] = 1;
  write(mesh, 0, zeros, parts);
  const std::string first = fingerprint();
  write("# a triangle\n" + mesh, 0, zeros, parts);
  CHECK(fingerprint() == first);
  write("v 9 9 9\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", 0, zeros, parts);
  CHECK(fingerprint() != first);
  write(mesh, 1e-9, zeros, parts);
  CHECK(fingerprint() != first);
  write(mesh, 0, moved, parts);
  CHECK(fingerprint() != first);
  write(mesh, 0, zeros, mesh + "o roof\nf 1 3 2\n");
  CHECK(fingerprint() != first);
  write(mesh, 0, zeros, parts);
  CHECK(fingerprint() == first);
  file["queries"][0]["D"] = 9;
  CHECK(fingerprint() != first);
}

TEST_CASE("a workload that is written and read back has the same bits") {
  const ScratchFolder folder;
  Workload workload = makeWorkload(Figure7{3, 100, 2});
  workload.meshes.push_back(makeWorkload(Soups{}).meshes[4]);
  workload.scenes[1].masks = {{0, 3}, {101, 0}};
  workload.queries[0].mask = 17;
  workload.queries[1].mode = AnswerMode::reference;
  workload.queries[1].anyHit = true;
  workload.queries[1].tolerance = 0.1;
  workload.queries[2].id = "odd \"id\"\n\\ \xc3\xa4";
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, folder.path() / "new" / "folder"), warnings).all();
  REQUIRE(again.meshes.size() == workload.meshes.size());
  for (size_t i = 0; i < workload.meshes.size(); ++i) {
    CHECK(again.meshes[i].positions == workload.meshes[i].positions);
    CHECK(again.meshes[i].indices == workload.meshes[i].indices);
  }
  REQUIRE(again.scenes.size() == workload.scenes.size());
  for (size_t i = 0; i < workload.scenes.size(); ++i) {
    CHECK(again.scenes[i].id == workload.scenes[i].id);
    CHECK(again.scenes[i].base == workload.scenes[i].base);
    CHECK(again.scenes[i].instances == workload.scenes[i].instances);
    CHECK(again.scenes[i].masks == workload.scenes[i].masks);
  }
  REQUIRE(again.queries.size() == workload.queries.size());
  for (size_t i = 0; i < workload.queries.size(); ++i) {
    const QuerySpec &a = again.queries[i], &b = workload.queries[i];
    CHECK((a.id == b.id && a.scene == b.scene && a.batch == b.batch && a.sensor() == b.sensor()));
    CHECK((a.exclude == b.exclude && a.direction == b.direction && a.distance == b.distance));
    CHECK((a.mask == b.mask && a.anyHit == b.anyHit && a.mode == b.mode && a.speed == b.speed));
    CHECK(a.tolerance == b.tolerance);
  }
}

TEST_CASE("a query may ask what counts as a contact and for how many, and is written as it was read") {
  Files files;
  nlohmann::json file = goodFile();
  file["queries"][0].update(
      nlohmann::json::parse(R"({"ignore_leaving": true, "slack": 1e-9, "skip_overlapping": true, "hits": "all",
                              "clearance": 0.5})"));
  const Workload workload = files.read(file.dump());
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, files.folder.path() / "again"), warnings).all();
  for (const QuerySpec& query : {workload.queries[0], again.queries[0]}) {
    CHECK(query.ignoreLeaving);
    CHECK(query.slack == 1e-9);
    CHECK(query.skipOverlapping);
    CHECK(query.hits == radar::kAllHits);
    CHECK(query.clearance == 0.5);
  }
  CHECK_FALSE((workload.queries[1].ignoreLeaving || workload.queries[1].slack || workload.queries[1].skipOverlapping));
  CHECK(workload.queries[1].hits == 1);
}

TEST_CASE("scenes without an id are written without one and read again") {
  // Each was written with the id "", which no two scenes may have.
  Files files;
  nlohmann::json file = goodFile();
  for (nlohmann::json& scene : file["scenes"]) scene.erase("id");
  const Workload workload = files.read(file.dump());
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, files.folder.path() / "again"), warnings).all();
  REQUIRE(again.scenes.size() == 2);
  CHECK(again.scenes[1].id.empty());
  CHECK(again.scenes[1].base == 0u);
}
