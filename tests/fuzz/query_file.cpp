// Fuzzes query files: an input is the JSON text. What is read keeps the contracts of the scene and its queries, is
// written and read again unchanged, and is answered.
#include <algorithm>
#include <iostream>
#include <sstream>

#include "batch/binary_queries.h"
#include "batch/query_file.h"
#include "fuzz/check_batch.h"
#include "fuzz/target.h"
#include "support/scratch_folder.h"
#include "workloads/query_fields.h"

namespace radar::fuzz {

namespace {

using namespace tools;

/// The folder with the files that query files name, which is the current one.
struct Files {
  Files() {
    // Each has a name with which it is read here, not by assimp in a child process, if it is named as a mesh.
    folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    folder.write("b.off", "OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 0 3 2\n");
    folder.write("parts.obj", "v 0 0 0\nv 2 0 0\nv 0 2 0\nv 0 0 2\no x\nf 1 2 3\no y\nf 1 3 4\no x z\nl 1 2\n");
    tools::writePlaced(
        std::vector<tools::Instance>{
            {0, {}}, {1, {{1, 0, 0, 3, 0, 1, 0, 0, 0, 0, 1, 0}}}, {0, {{2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2, -3.5}}}},
        folder.path() / "instances.stl");
    folder.write("broken.stl", "0 1\n");
    std::string floats(9 * sizeof(float), '\0');
    floats[15] = '\x40';
    folder.write("positions.ply", floats);
    std::filesystem::current_path(folder.path());
  }
  test::ScratchFolder folder;
};

/// Reads it as standard input.
Workload readText(const std::string& text) {
  std::istringstream stream(text);
  std::streambuf* const before = std::cin.rdbuf(stream.rdbuf());
  std::vector<std::string> warnings;
  try {
    Workload workload = QueryFile("-", warnings).all();
    std::cin.rdbuf(before);
    return workload;
  } catch (...) {
    std::cin.rdbuf(before);
    throw;
  }
}

bool areSame(const QuerySpec& a, const QuerySpec& b) {
  const auto same = [&](const QueryField& field) {
    return std::visit([&](auto member) { return a.*member == b.*member; }, field.member);
  };
  const auto sameTurn = [](const Turn& of, const Turn& other) {
    return of.axis == other.axis && of.angle == other.angle && of.centre == other.centre;
  };
  if (a.turn.has_value() != b.turn.has_value() || (a.turn && !sameTurn(*a.turn, *b.turn))) return false;
  return a.id == b.id && a.scene == b.scene && a.batch == b.batch && a.sensor() == b.sensor() && a.mode == b.mode &&
         a.direction == b.direction && a.distance == b.distance && a.motion == b.motion && a.chain == b.chain &&
         std::ranges::all_of(queryFields(), same);
}

/// Written and read again, a workload is the same.
void checkRoundTrip(const Workload& workload, const std::filesystem::path& folder) {
  std::vector<std::string> warnings;
  const Workload again = QueryFile(writeQueryFile(workload, folder), warnings).all();
  const auto sameMesh = [](const MeshData& a, const MeshData& b) {
    return a.positions == b.positions && a.indices == b.indices;
  };
  const auto sameDeformation = [](const Deformation& a, const Deformation& b) {
    return a.mesh == b.mesh && a.positions == b.positions;
  };
  const auto sameScene = [&](const SceneSpec& a, const SceneSpec& b) {
    return a.id == b.id && a.base == b.base && a.instances == b.instances && a.masks == b.masks &&
           a.motions == b.motions && std::ranges::equal(a.deforms, b.deforms, sameDeformation);
  };
  const auto sameLink = [](const Link& a, const Link& b) {
    const auto samePlace = [](const LinkMesh& c, const LinkMesh& d) {
      return c.mesh == d.mesh && c.linkFromMesh == d.linkFromMesh;
    };
    return a.parent == b.parent && a.parentFromJoint == b.parentFromJoint && a.joint == b.joint && a.axis == b.axis &&
           a.variable == b.variable && std::ranges::equal(a.meshes, b.meshes, samePlace);
  };
  const auto sameChain = [&](const ChainSpec& a, const ChainSpec& b) {
    return std::ranges::equal(a.links, b.links, sameLink) && a.pairs == b.pairs && a.linkNames == b.linkNames &&
           a.variableNames == b.variableNames;
  };
  require(std::ranges::equal(workload.chains, again.chains, sameChain), "other chains when read again");
  require(std::ranges::equal(workload.meshes, again.meshes, sameMesh), "other meshes when read again");
  require(std::ranges::equal(workload.scenes, again.scenes, sameScene), "other scenes when read again");
  require(std::ranges::equal(workload.queries, again.queries, areSame), "other queries when read again");
}

void run(std::string_view input) {
  static const Files files;
  Workload workload;
  try {
    workload = readText(std::string(input));
  } catch (const InputError& error) {
    return checkMessage("standard input", error.what());
  }
  checkBatch(workload);
  // Which writes files, and so takes long.
  if (std::hash<std::string_view>()(input) % 32 == 0) checkRoundTrip(workload, files.folder.path() / "again");
}

std::vector<std::string> seeds() {
  const std::string head = R"({"format": "cyber-radar-queries-1", "meshes": )";
  return {
      head + R"(["a.obj"], "scenes": [{"id": "a", "instances": [[0], [0, 1,0,0,5, 0,1,0,0, 0,0,1,0]]},
 {"id": "b", "base": 0, "instances": [[0, 2,0,0,0, 0,-2,0,0, 0,0,2,1e-3]], "masks": [[1, 6]]}],
 "queries": [{"id": "p", "scene": 0, "sensor": [0], "dir": [0, 0, 1], "D": 8},
 {"id": "q", "scene": 1, "batch": 3, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-2], "exclude": [2], "dir": [0, -0.5, 1],
  "D": 0, "mask": 5, "any_hit": true, "mode": "sampled", "speed": 2.5, "tolerance": 0.25}]})",
      head +
          R"([{"file": "a.obj", "scale": 0.001}, "b.off", "parts.obj#1", "parts.obj#x z"], "scenes": [], "queries": []})",
      head +
          R"(["a.obj", "b.off", "parts.obj#1"], "scenes": [{"instances_file": "instances.stl", "motions": [[1, 0, 0, -3]]}],
 "queries": [{"id": "p", "scene": 0, "sensor": [1, 1,0,0,0, 0,1,0,0, 0,0,1,-2], "motion": [0, 0.5, 4], "hits": "all"},
 {"id": "q", "scene": 0, "sensor": [2], "motion": [0, 0, 0], "skip_overlapping": true, "slack": 1e-9},
 {"id": "r", "scene": 0, "sensor": [2], "motion": [0, 0, 1], "turn": {"axis": [0, 1, 2], "angle": 1.5, "centre": [0, 0, 9]}, "ignore_leaving": true},
 {"id": "s", "scene": 0, "sensor": [2], "turn": {"to": [0,-1,0,2, 1,0,0,0, 0,0,1,3], "about": [0, 1, 0]}}]})",
      head + R"(["b.off"], "scenes": [{"assembly": "parts.obj", "deforms": []}, {"base": 0, "instances": [[0]]}],
 "queries": [{"id": "p", "scene": 1, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-5], "dir": [0, 0, 1], "D": 9, "clearance": 0.25, "closest": true, "exit": true},
 {"id": "q", "scene": 1, "sensor": [0], "dir": [1, 0, 0], "D": 3, "ignore_leaving": true, "hits": 2, "mode": "contact"}]})",
      head +
          R"(["a.obj", "b.off"], "scenes": [{"instances": [[1, 1,0,0,2, 0,1,0,2, 0,0,1,0], [0]], "motions": [[1, 0, 1, 0]]}],
 "queries": [{"id": "p", "scene": 0, "sensor": [0, 1,0,0,4, 0,1,0,0, 0,0,1,0.5], "turn": {"axis": [0, 1, 2], "angle": 4, "centre": [1, 0, 0]}},
 {"id": "q", "scene": 0, "sensor": [1], "turn": {"axis": [0, 0, 1], "angle": -3, "centre": [2, 0, 0.5]}, "motion": [0, 0, 1], "clearance": 0.25},
 {"id": "r", "scene": 0, "sensor": [1], "exclude": [1], "turn": {"axis": [1, 0, 0], "angle": 2, "centre": [0, 2, 0]}, "any_hit": true}]})",
      head +
          R"(["a.obj", "b.off"], "chains": [{"links": [{"name": "x", "meshes": [[0], [1, 1,0,0,0, 0,1,0,0, 0,0,1,-2]]},
 {"name": "y", "parent": "x", "joint": "revolute", "axis": [0, 1, 1], "variable": "q", "meshes": [[1]]},
 {"name": "z", "parent": "y", "joint": "prismatic", "origin": [0,-1,0,3, 1,0,0,0, 0,0,1,0], "meshes": [[0]]}],
 "ignored": [["x", "y"]]}], "scenes": [{"instances": [[1, 1,0,0,2, 0,1,0,2, 0,0,1,0]]}],
 "queries": [{"id": "p", "scene": 0, "chain": 0, "from": [0, 1], "to": [1.5, -1], "base": [1,0,0,0, 0,1,0,0, 0,0,1,5]},
 {"id": "q", "scene": 0, "chain": 0, "from": [0.5, 1], "to": [-2, 0.5], "clearance": 0.25, "exclude": [0]}]})",
      head + R"(["a.obj"], "scenes": [{"instances": [[0]], "deforms": [[0, "positions.ply"]]}, {"instances": []}],
 "queries": [{"id": "p", "scene": 0, "sensor": [0, 1,0,0,0, 0,1,0,0, 0,0,1,-5], "dir": [0, 0, 1], "D": 9, "mode": "reference"},
 {"id": "q", "scene": 0, "batch": 18446744073709551615, "sensor": [0], "dir": [1, 0, 0], "D": 0},
 {"id": "r", "scene": 1, "sensor": [0], "dir": [1, 0, 0], "D": 1e308}]})"};
}

constexpr const char* kWords =
    R"("format"~"meshes"~"scenes"~"queries"~"id"~"base"~"instances"~"instances_file"~"assembly"~"masks"~)"
    R"("motions"~"deforms"~"scene"~"batch"~"sensor"~"exclude"~"dir"~"D"~"motion"~"turn"~"axis"~"angle"~"centre"~"to"~"about"~"chains"~"links"~"pairs"~"ignored"~"name"~"parent"~"joint"~"origin"~"variable"~"chain"~"from"~"revolute"~"prismatic"~"fixed"~"x"~"y"~"mask"~"any_hit"~"mode"~"speed"~)"
    R"("file"~"scale"~"tolerance"~"ignore_leaving"~"slack"~"skip_overlapping"~"closest"~"exit"~"hits"~"clearance"~"rotation"~"all"~"sampled"~)"
    R"("contact"~"reference"~"a.obj"~"b.off"~"parts.obj"~"parts.obj#0"~"parts.obj#x"~"instances.stl"~)"
    R"("broken.stl"~"positions.ply"~null~true~false~[~]~{~}~, ~: ~0~-1~1~2~0.5~1e999~1e308~-1e-320~4294967295~)"
    R"(4294967296~18446744073709551615~18446744073709551616~\u0000~\ud800~[0], ~)"
    R"([0, 1,0,0,0, 0,1,0,0, 0,0,1,0], )"
    "~\xff";

}  // namespace

const Target& target() {
  static const Target kTarget{run, seeds, separated(kWords)};
  return kTarget;
}

}  // namespace radar::fuzz
