// Query files of chains: what answers say, and in which forms.
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "cli/page_data.h"
#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

/// An upper arm 10 long, a finger 3 long at its end, which folds back onto it, and a wall across y = 8.
void writeArm(const ScratchFolder& folder) {
  const std::string box =
      "f 1 3 4\nf 1 4 2\nf 5 6 8\nf 5 8 7\nf 1 2 6\nf 1 6 5\nf 3 7 8\nf 3 8 4\nf 1 5 7\nf 1 7 3\nf 2 4 8\nf 2 8 6\n";
  const auto boxOf = [&](const std::string& x, const std::string& y) {
    std::string text;
    for (int i = 0; i < 8; ++i) {
      text += "v " + std::string(i & 1 ? "" : "-") + x + (i & 2 ? " " : " -") + y + (i & 4 ? " .5\n" : " -.5\n");
    }
    return text + box;
  };
  folder.write("upper.obj", boxOf("5", ".5"));
  folder.write("finger.obj", boxOf(".5", "1"));
  folder.write("wall.obj", "v -30 8 -9\nv 30 8 -9\nv 0 8 30\nf 1 2 3\n");
  folder.write("q.json", R"({"format": "cyber-radar-queries-1", "meshes": ["upper.obj", "finger.obj", "wall.obj"],
    "chains": [{"links": [
      {"name": "upper", "joint": "revolute", "axis": [0, 0, 1], "meshes": [[0, 1,0,0,5, 0,1,0,0, 0,0,1,0]]},
      {"name": "fore", "parent": "upper", "joint": "revolute", "origin": [1,0,0,10, 0,1,0,0, 0,0,1,0],
       "axis": [0, 0, -2], "meshes": [[1, 1,0,0,6, 0,1,0,2, 0,0,1,0]]}],
      "pairs": [["upper", "fore"]]}],
    "scenes": [{"id": "wall", "instances": [[2]]}, {"id": "empty", "instances": []}],
    "queries": [
      {"id": "folds", "scene": 1, "chain": 0, "from": [0.3, 0], "to": [1.3, -3.141592653589793],
       "base": [1,0,0,100, 0,1,0,-50, 0,0,1,20]},
      {"id": "sweep", "scene": 0, "sensor": [1], "dir": [0, 1, 0], "D": 20},
      {"id": "swings", "scene": 0, "chain": 0, "from": [0, 0], "to": [1.5707963267948966, 0]},
      {"id": "excluded", "scene": 0, "chain": 0, "from": [0, 0], "to": [1.5, 0], "exclude": [0]},
      {"id": "near", "scene": 0, "chain": 0, "from": [0, 0], "to": [1.5, 0], "clearance": 1, "tolerance": 1e-3},
      {"id": "whether", "scene": 0, "chain": 0, "from": [0, 0], "to": [1.5, 0], "any_hit": true}]})");
}

}  // namespace

TEST_CASE("a chain's answers name its links, and the moment that geometry says") {
  const ScratchFolder folder;
  writeArm(folder);
  const Run run = succeed(folder, "query q.json");
  const auto answers = linesOf(run.out);
  REQUIRE(answers.size() == 6);
  const auto& folds = answers[0];
  CAPTURE(folds.dump());
  // The finger's outer inner corner is the first to come down on the arm's upper side.
  const double pi = 3.141592653589793, fold = (pi - std::asin(0.5 / std::hypot(5.5, 3)) - std::atan2(3, 5.5)) / pi;
  CHECK((folds["status"] == "hit" && folds["tier"] == "reference"));
  CHECK(folds["fraction_lo"].get<double>() <= fold + 1e-12);
  CHECK(folds["fraction_hi"].get<double>() >= fold - 1e-12);
  CHECK(folds["fraction_hi"].get<double>() - folds["fraction_lo"].get<double>() < 1e-6);
  CHECK((folds["link"] == 0 && folds["link_name"] == "upper" && folds["mesh"] == 0));
  CHECK((folds["other_link"] == 1 && folds["other_link_name"] == "fore" && folds["other_mesh"] == 0));
  CHECK((folds["object"].is_null() && folds["tri_a"].is_number() && folds["tri_b"].is_number()));
  CHECK((answers[1]["status"] == "hit" && answers[1]["t"] == 7 && !answers[1].contains("link")));
  // The finger's far corner, (16.5, 3) at first, is the first to reach y = 8.
  const double swing = (std::asin(8 / std::hypot(16.5, 3)) - std::atan2(3, 16.5)) / (pi / 2);
  const auto& swings = answers[2];
  CAPTURE(swings.dump(), swing);
  CHECK(std::abs(swings["t"].get<double>() - swing) < 1e-6);
  CHECK((swings["link_name"] == "fore" && swings["object"] == 0 && swings["other_link"].is_null()));
  CHECK(std::abs(swings["point"][1].get<double>() - 8) < 1e-4);
  CHECK((answers[3]["status"] == "clear" && answers[3]["link"].is_null() && answers[3]["link_name"].is_null()));
  CHECK((answers[4]["gap"].get<double>() < 1.0011 && answers[4]["t"] < swings["t"] && answers[4]["link"] == 1));
  CHECK((answers[5]["status"] == "hit" && answers[5]["link"].is_null()));
  CHECK_THAT(runProgram(folder, "query q.json --check").out,
             Contains("3 meshes of 25 triangles, 1 chain, 2 scenes of 1 object") &&
                 Contains("6 queries: 1 contact, 5 reference"));
}

TEST_CASE("answers of chains go through shards, streams and tables, and are compared by their links") {
  const ScratchFolder folder;
  writeArm(folder);
  succeed(folder, "query q.json --mode reference --out a.jsonl");
  const std::string answers = folder.read("a.jsonl");
  for (const char* shard : {"0/2", "1/2"}) {
    const std::string part = std::string("part-") + shard[0];
    succeed(folder, "query q.json --mode reference --out " + part + " --shard " + shard);
  }
  succeed(folder, "merge part-0 part-1 --out merged.jsonl");
  CHECK(folder.read("merged.jsonl") == answers);
  folder.write("lines.jsonl",
               R"({"id": "swings", "scene": 0, "chain": 0, "from": [0, 0], "to": [1.5707963267948966, 0]})"
               "\n");
  const size_t begin = answers.find("{\"id\": \"swings"), end = answers.find("{\"id\": \"excluded");
  const Run stream = runProgram(folder, "stream q.json --mode reference < lines.jsonl");
  CHECK(stream.out == answers + answers.substr(begin, end - begin));
  succeed(folder, "query q.json --mode reference --out a.csv");
  CHECK_THAT(folder.read("a.csv"),
             Contains(",link,mesh,object,other_link,other_mesh,tri_a,tri_b,") && Contains("\nfolds,hit,"));
  checkRefused(folder, "query q.json --mode reference --out a.npy",
               "--out: a.npy: expected another file than .npy, as answers of a \"chain\" name links (query \"folds\")");
  succeed(folder, "compare a.jsonl merged.jsonl");
  std::string other = answers;
  other.replace(other.find("\"other_link\": 1"), 15, "\"other_link\": 0");
  folder.write("b.jsonl", other);
  const Run compared = runProgram(folder, "compare a.jsonl b.jsonl");
  CHECK(compared.status == 1);
  CHECK_THAT(compared.out, Contains("to query \"folds\": other_link: 1 in a.jsonl, 0 in b.jsonl"));
  checkRefused(folder, "scale q.json", "q.json: queries: expected queries of sensors alone, got \"folds\" of a chain");
  checkRefused(folder, "chart --out c q.json", "q.json: queries: expected queries of sensors alone", runLab);
  checkRefused(folder, "scopes q.json --query folds --out s", "q.json: chain: expected a straight motion");
}

TEST_CASE(
    "a page of chains is the same whether its answers are found or read, and answers of other chains are refused") {
  const ScratchFolder folder;
  writeArm(folder);
  succeed(folder, "query q.json --out a.jsonl");
  succeed(folder, "view q.json --out found.html --gltf found.glb");
  succeed(folder, "view q.json a.jsonl --out read.html --gltf read.glb");
  CHECK(folder.read("read.html") == folder.read("found.html"));
  CHECK(folder.read("read.glb") == folder.read("found.glb"));
  const auto data = pageData(folder.read("found.html"));
  CHECK(data["chains"][0]["links"][1]["name"] == "fore");
  CHECK(data["queries"]["moves"].size() == 5);
  CHECK(data["queries"]["moves"]["2"]["from"] == nlohmann::json({0, 0}));
  CHECK(data["queries"]["moves"]["0"]["base"][3] == 100);
  const std::string answers = folder.read("a.jsonl");
  for (const auto& [from, to, words] :
       {std::tuple{"\"link\": 0", "\"link\": 2", "line 1: link: expected a whole number below 2, got 2"},
        std::tuple{"\"mesh\": 0", "\"mesh\": null", "line 1: mesh: expected the number of a mesh, got none"},
        std::tuple{"\"other_mesh\": 0", "\"other_mesh\": 1",
                   "line 1: other_mesh: expected a whole number below 1, got 1"},
        std::tuple{"\"tri_b\": 6", "\"tri_b\": 12", "line 1: tri_b: expected a whole number below 12, got 12"}}) {
    std::string other = answers;
    other.replace(other.find(from), std::string_view(from).size(), to);
    folder.write("b.jsonl", other);
    checkRefused(folder, "view q.json b.jsonl --out v.html", words);
  }
}
