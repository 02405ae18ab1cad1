// Chains in query files.
#include "query_texts.h"

using namespace radar;
using namespace radar::test;
using namespace radar::tools;

namespace {

constexpr const char* kChains = R"([{"links": [{"name": "foot", "meshes": [[0]]},
  {"name": "rail", "parent": "foot", "joint": "prismatic", "meshes": [[0]]},
  {"name": "arm", "parent": "rail", "joint": "revolute", "axis": [0, 3, 4], "variable": "q",
   "origin": [1,0,0,0.1, 0,0,-1,0, 0,1,0,0], "meshes": [[0], [0, 2,0,0,0, 0,2,0,-2, 0,0,2,0]]},
  {"name": "wrist", "parent": "arm"},
  {"name": "hand", "parent": "wrist", "joint": "revolute", "variable": "q", "meshes": [[0]]}]}])";
constexpr const char* kChainQuery = R"({"id": "r", "scene": 0, "chain": 0, "from": [0, 0.1], "to": [-1e-3, 3],
  "base": [1,0,0,7, 0,1,0,0, 0,0,1,0], "clearance": 0.5, "exclude": [1]})";

}  // namespace

TEST_CASE("chains are read, written and read back with the same bits") {
  Files files;
  nlohmann::json file = goodFile();
  file["chains"] = nlohmann::json::parse(kChains);
  file["queries"].push_back(nlohmann::json::parse(kChainQuery));
  const Workload workload = files.read(file.dump());
  REQUIRE(workload.chains.size() == 1);
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, files.folder.path() / "again"), warnings).all();
  for (const Workload* const read : {&workload, &again}) {
    const ChainSpec& chain = read->chains[0];
    CHECK(chain.linkNames == std::vector<std::string>{"foot", "rail", "arm", "wrist", "hand"});
    CHECK(chain.variableNames == std::vector<std::string>{"rail", "q"});
    CHECK(chain.variables == 2);
    // Of rail, arm and hand, those that a joint joins are not tested with each other; the wrist is fixed to the arm.
    CHECK(chain.pairs == std::vector<std::array<uint32_t, 2>>{{0, 2}, {0, 4}, {1, 4}});
    CHECK(
        (chain.links[1].joint == JointType::prismatic && chain.links[1].parent == 0u && chain.links[1].variable == 0));
    CHECK((chain.links[2].axis == std::array<double, 3>{0, 3, 4} && chain.links[2].parentFromJoint.m[3] == 0.1));
    CHECK((chain.links[3].joint == JointType::fixed && chain.links[4].variable == 1));
    CHECK((chain.links[2].meshes.size() == 2 && chain.links[2].meshes[1].linkFromMesh.m[7] == -2));
    const QuerySpec& query = read->queries[2];
    CHECK(query.chain == ChainWay{0, {0, 0.1}, {-1e-3, 3}});
    CHECK((query.worldFromMesh.m[3] == 7 && query.clearance == 0.5 && query.exclude == std::vector<ObjectId>{1}));
    CHECK(query.mode == AnswerMode::reference);
  }
  file["chains"][0]["ignored"] = nlohmann::json::parse(R"([["hand", "foot"]])");
  CHECK(files.read(file.dump()).chains[0].pairs.size() == 2);
  file["chains"][0]["pairs"] = nlohmann::json::parse(R"([["foot", "hand"], ["hand", "arm"]])");
  CHECK(files.read(file.dump()).chains[0].pairs == std::vector<std::array<uint32_t, 2>>{{4, 2}});

  const struct {
    const char *pointer, *value, *path, *problem;
  } cases[] = {
      {"/chains/0/joints", "[]", "chains[0].joints: ", "one of the keys links, pairs, ignored"},
      {"/chains/0/links/0/limits", "[]", "chains[0].links[0].limits: ", "one of the keys name, parent"},
      {"/chains/0/links/2/name", "\"foot\"", "chains[0].links[2].name: ", "no other link"},
      {"/chains/0/links/1/parent", "\"arm\"", "chains[0].links[1].parent: ", "the name of a link before it"},
      {"/chains/0/links/2/joint", "\"planar\"",
       "chains[0].links[2].joint: ", "\"revolute\" or \"prismatic\", got \"planar\""},
      {"/chains/0/links/2/axis", "[0, 0, 0]", "chains[0].links[2].axis: ", "not zero"},
      {"/chains/0/links/3/axis", "[0, 0, 1]", "chains[0].links[3].axis: ", "none of a fixed joint"},
      {"/chains/0/links/3/variable", "\"q\"", "chains[0].links[3].variable: ", "none of a fixed joint"},
      {"/chains/0/links/2/origin", "[1,0,0,0, 0,1,0,0, 0,0,1.001,0]", "chains[0].links[2].origin: ", "a rigid pose"},
      {"/chains/0/links/2/origin", "[1]", "chains[0].links[2].origin: ", "12 numbers"},
      {"/chains/0/links/2/meshes/0/0", "1", "chains[0].links[2].meshes[0][0]: ", "one of the 1 meshes"},
      {"/chains/0/links/2/meshes/0", "[0, 1,0,0,1e100, 0,1,0,0, 0,0,1,0]", "chains[0].links[2].meshes[0]: ", "2^300"},
      {"/chains/0/pairs", "[[\"arm\", \"leg\"]]", "chains[0].pairs[0][1]: ", "the name of a link, got \"leg\""},
      {"/chains/0/ignored", "[[\"arm\", \"arm\"]]", "chains[0].ignored[0]: ", "the names of two links"},
      {"/queries/2/chain", "1", "queries[2].chain: ", "one of the 1 chains"},
      {"/queries/2/from", "[1]", "queries[2].from: ", "expected 2 numbers, got 1"},
      {"/queries/2/to/1", "7e4", "queries[2].to: ", "an angle up to 2^16"},
      {"/queries/2/to/1", "\"7\"", "queries[2].to[1]: ", "a finite number"},
      {"/queries/2/base", "[2,0,0,0, 0,2,0,0, 0,0,2,0]", "queries[2].base: ", "a rigid pose"},
      {"/queries/2/exclude/0", "2", "queries[2].exclude[0]: ", "one of the 2 objects"},
      {"/queries/2/clearance", "1e301", "queries[2].clearance: ", "0 to 2^300"},
      {"/queries/2/sensor", "[0]",
       "queries[2].sensor: ", "one of the keys id, scene, batch, chain, from, to, base, any_hit"},
      {"/queries/2/hits", "2", "queries[2].hits: ", "got \"hits\""},
      {"/queries/2/mode", "\"sampled\"", "queries[2].mode: ", "got \"mode\""},
      {"/queries/0/from", "[0]", "queries[0].from: ", "got \"from\""},
  };
  file["chains"] = nlohmann::json::parse(kChains);
  for (const auto& c : cases) {
    CAPTURE(c.pointer, c.value);
    nlohmann::json changed = file;
    changed[nlohmann::json::json_pointer(c.pointer)] = nlohmann::json::parse(c.value);
    CHECK_THAT(files.refusal(changed.dump()), StartsWith(c.path) && Contains(c.problem));
  }
}
