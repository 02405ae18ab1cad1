#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

/// A tetrahedron, wound outwards, in two objects of two faces each.
constexpr const char* kParts = "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\no lid\nf 1 3 2\nf 1 2 4\no box\nf 1 4 3\nf 2 3 4\n";

}  // namespace

TEST_CASE("info names a file's nodes as query files do, and says how each is closed and wound") {
  const ScratchFolder folder;
  folder.write("two parts.obj", kParts);
  const Run run = succeed(folder, "info 'two parts.obj'");
  CHECK(run.out ==
        "two parts.obj: 2 nodes, 4 triangles, 12 vertices\n"
        "  2 x 1 x 1, from (0, 0, 0) to (2, 1, 1)\n"
        "  closed, wound outwards; volume 0.333333\n"
        "  #0 \"lid\": 2 triangles, 6 vertices; 2 x 1 x 1, from (0, 0, 0) to (2, 1, 1); open: 4 border edges\n"
        "  #1 \"box\": 2 triangles, 6 vertices; 2 x 1 x 1, from (0, 0, 0) to (2, 1, 1); open: 4 border edges\n");
  const std::string sweep = "sweep 'two parts.obj#";
  CHECK_THAT(runProgram(folder, sweep + "lid' 'two parts.obj#1' --direction 1 0 0 --distance 1 --json").out,
             Contains("overlap"));
}

TEST_CASE("info as JSON has the same of all files, and warnings and units are told") {
  const ScratchFolder folder;
  folder.write("a.obj", kParts + std::string("p 1\n"));
  folder.write("b.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  const Run run = runProgram(folder, "info a.obj b.off --json");
  CHECK_THAT(run.err, Contains("cyber-radar: warning: a.obj: dropped 1 point and 0 lines"));
  const auto files = nlohmann::json::parse(run.out);
  REQUIRE(files.size() == 2);
  CHECK((files[0]["file"] == "a.obj" && files[0]["unit"].is_null()));
  CHECK((files[0]["closed"] == true && files[0]["shells"] == 1 && files[0]["inward_shells"] == 0));
  CHECK(files[0]["high"] == nlohmann::json({2, 1, 1}));
  REQUIRE(files[0]["nodes"].size() == 2);
  CHECK((files[0]["nodes"][1]["number"] == 1 && files[0]["nodes"][1]["name"] == "box"));
  CHECK((files[1]["closed"] == false && files[1]["border_edges"] == 3 && files[1]["volume"].is_null()));
}

TEST_CASE("info tells which nodes share a mesh, and the unit of glTF") {
  const ScratchFolder folder;
  const std::string triangle("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36);
  folder.write("a.bin", triangle);
  folder.write("a.gltf",
               R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"mesh": 0, "name": "left"}, {"mesh": 0, "name": "on the right", "translation": [5, 0, 0]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "a.bin", "byteLength": 36}]})");
  CHECK_THAT(runProgram(folder, "info a.gltf").out,
             Contains("in the unit meter") &&
                 Contains("#1 \"on the right\": the mesh of #0; 1 x 1 x 0, from (5, 0, 0) to (6, 1, 0)\n"));
  CHECK_THAT(runProgram(folder, "sweep a.gltf 'a.gltf#on the right' --direction 1 0 0 --distance 1").out,
             Contains("a.gltf#on the right, 1 triangle"));
}

TEST_CASE("info refuses what is no mesh file, as the readers do") {
  const ScratchFolder folder;
  folder.write("empty.obj", "");
  folder.write("points.obj", "v 0 0 0\np 1\n");
  for (const auto& [arguments, words] :
       {std::pair{"no.obj", "no.obj: expected a mesh file"}, std::pair{".", "got a folder"},
        std::pair{"empty.obj", "empty.obj: expected a mesh file, got an empty one"},
        std::pair{"points.obj", "points.obj: expected at least one triangle"}, std::pair{"", "FILE is required"}}) {
    checkRefused(folder, std::string("info ") + arguments, words);
  }
}
