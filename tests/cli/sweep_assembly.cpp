// sweep in a scene of several nodes, and in another unit.
#include <nlohmann/json.hpp>

#include "cli/program.h"
#include "support/catch.h"

using namespace radar::test;

namespace {

/// Three sheets above each other, 1 apart, as nodes of one mesh.
void writeTower(const ScratchFolder& folder) {
  folder.write("a.bin",
               std::string("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0\0\0\0\0\0\0\0\0\0\0\x80\x3f\0\0\0\0", 36));
  folder.write("tower block.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
    "nodes": [{"mesh": 0, "name": "ground"}, {"mesh": 0, "name": "first floor", "translation": [0, 0, 1]},
              {"mesh": 0, "name": "roof", "translation": [0, 0, 2]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"uri": "a.bin", "byteLength": 36}]})");
  folder.write("a.stl",
               "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
               "endfacet\nendsolid\n");
}

const std::string kUp = "sweep 'tower block.gltf' a.stl --at 0 0 -1 --direction 0 0 1 --distance 9 ";

nlohmann::json answerOf(const ScratchFolder& folder, const std::string& arguments) {
  const Run run = runProgram(folder, arguments + " --json");
  INFO(arguments << run.err);
  REQUIRE(run.status == 0);
  return nlohmann::json::parse(run.out);
}

}  // namespace

TEST_CASE("sweep names the node that is touched, lists others and leaves out what it is told to") {
  const ScratchFolder folder;
  writeTower(folder);
  const nlohmann::json first = answerOf(folder, kUp);
  CHECK((first["object"] == 0 && first["object_name"] == "ground" && first["t"] == 1));
  const nlohmann::json second = answerOf(folder, kUp + "--exclude ground");
  CHECK((second["object"] == 1 && second["object_name"] == "first floor" && second["t"] == 2));
  const nlohmann::json third =
      answerOf(folder, "sweep --exclude 0,'first floor' " + kUp.substr(std::string("sweep ").size()));
  CHECK((third["object"] == 2 && third["t"] == 3));
  const Run words = runProgram(folder, kUp + "--hits all");
  CHECK_THAT(words.out, Contains("scene:  tower block.gltf, 3 objects, 3 triangles\n") &&
                            Contains("of object 0 \"ground\" (tower block.gltf#0)") &&
                            Contains("\n  then    object 1 \"first floor\" (tower block.gltf#0) after 2\n") &&
                            Contains("\n  then    object 2 \"roof\" (tower block.gltf#0) after 3\n"));
  CHECK(answerOf(folder, kUp + "--hits 2")["hits"].size() == 2);
  CHECK_THAT(runProgram(folder, kUp + "--mode sampled --hits 2").err,
             Contains("--mode: expected contact or reference"));
  // A file of one node is one object without a name, and so is one node, in its own frame.
  CHECK_FALSE(answerOf(folder, "sweep a.stl a.stl --at 0 0 -1 --direction 0 0 1 --distance 9").contains("object_name"));
  CHECK(answerOf(folder, "sweep 'tower block.gltf#roof' a.stl --at 0 0 -1 --direction 0 0 1 --distance 9")["t"] == 1);
}

TEST_CASE("sweep scales both files, or the sensor's otherwise") {
  const ScratchFolder folder;
  writeTower(folder);
  CHECK(answerOf(folder, kUp + "--scale 4 --exclude 0")["t"] == 1 + 4);
  // The sensor of half the size passes beside the scene's corner.
  const std::string beside = "sweep 'tower block.gltf' a.stl --at 0.4 0.4 -1 --direction 0 0 1 --distance 9 ";
  CHECK(answerOf(folder, beside)["status"] == "hit");
  CHECK(answerOf(folder, beside + "--scale 0.25")["status"] == "clear");
  CHECK(answerOf(folder, beside + "--scale 0.25 --sensor-scale 1")["status"] == "clear");
  CHECK(answerOf(folder, beside + "--sensor-scale 0.25")["status"] == "hit");
  const std::string outside = "sweep 'tower block.gltf' a.stl --at -0.5 0 -1 --direction 0 0 1 --distance 9 ";
  CHECK(answerOf(folder, outside)["status"] == "hit");
  CHECK(answerOf(folder, outside + "--sensor-scale 0.25")["status"] == "clear");
  CHECK_THAT(runProgram(folder,
                        "scopes 'tower block.gltf' a.stl --at 0 0 0.5 --direction 0 0 1 --distance 9 --scale 2 "
                        "--out p")
                 .out,
             Contains("min(L) = 1.5"));
}

TEST_CASE("sweep far from the origin names nodes and scales them alike") {
  const ScratchFolder folder;
  folder.write("far.obj",
               "v 512340678 4512350123 296250\nv 512341678 4512350123 296250\nv 512340678 4512351123 296250\n"
               "v 512340678 4512350123 297250\nv 512341678 4512350123 297250\nv 512340678 4512351123 297250\n"
               "o low\nf 1 2 3\no high\nf 4 5 6\n");
  folder.write("s.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const nlohmann::json answer =
      answerOf(folder,
               "sweep far.obj s.obj --scale 0.001 --sensor-scale 0.5 --at 512340.678 4512350.123 295.25 "
               "--direction 0 0 1 --distance 9 --exclude low");
  CHECK((answer["object"] == 1 && answer["object_name"] == "high"));
  CHECK(answer["t"].get<double>() == Approx(2).epsilon(0).margin(1e-9));
}

TEST_CASE("sweep refuses nodes that the scene does not have, and scales that are none") {
  const ScratchFolder folder;
  writeTower(folder);
  for (const auto& [arguments, words] :
       {std::pair{"--exclude cellar", "tower block.gltf#cellar: expected the name that one node with triangles has"},
        std::pair{"--exclude 3", "tower block.gltf#3: expected one of the 3 nodes, from 0"},
        std::pair{"--hits 0", "--hits: expected a whole number from 1 to 4294967294, or \"all\", got 0"},
        std::pair{"--hits some", "or \"all\", got"},
        std::pair{"--scale 0", "--scale: expected a finite number above 0"},
        std::pair{"--scale nan", "--scale: expected a finite number above 0, got nan"},
        std::pair{"--sensor-scale -1", "--sensor-scale: expected a finite number above 0, got -1"},
        std::pair{"--scale 1e39", "the scale 1e+39"}}) {
    checkRefused(folder, kUp + arguments, words);
  }
  folder.write("q.json", "{}");
  checkRefused(folder, "scopes q.json --query a --out p --scale 2", "--scale: expected no such option");
}
