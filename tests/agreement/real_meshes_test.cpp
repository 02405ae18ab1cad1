// Meshes that people made, as sensors and as scenes: from assimp's test models and CGAL's data, in several formats.
#include <catch2/catch.hpp>
#include <string>

#include "agreement/compare.h"
#include "import/mesh_import.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

std::vector<tools::MeshData> readAll(const std::string& folder, std::initializer_list<const char*> files) {
  std::vector<tools::MeshData> meshes;
  for (const char* file : files) {
    std::vector<std::string> warnings;
    meshes.push_back(tools::readMesh(folder + "/" + file, warnings));
  }
  return meshes;
}

void check(std::vector<tools::MeshData> meshes, uint32_t resolution) {
  const tools::Workload workload =
      tools::makeWorkload(tools::RandomPoses{.meshes = std::move(meshes), .objects = 300, .sensors = 40});
  const test::Tally tally = test::compareWithReference(workload, resolution);
  CAPTURE(tally.contacts, tally.found, tally.clear);
  CHECK(tally.contacts >= 10);
  CHECK(tally.found >= 0.8 * tally.contacts);
}

}  // namespace

TEST_CASE("assimp's test models in OBJ, PLY, STL, Collada and glTF sweep through each other") {
  check(readAll(RADAR_ASSIMP_MODELS,
                {"OBJ/spider.obj", "OBJ/WusonOBJ.obj", "PLY/Wuson.ply", "PLY/cube.ply", "STL/sphereWithHole.stl",
                 "STL/Spider_ascii.stl", "Collada/duck.dae", "glTF2/2CylinderEngine-glTF-Binary/2CylinderEngine.glb"}),
        128);
}

TEST_CASE("CGAL's meshes, closed and with holes, knotted and convoluted, sweep through each other") {
  check(readAll(RADAR_CGAL_MESHES, {"elephant.off", "elephant-with-holes.off", "knot1.off", "eight.off", "camel.off",
                                    "hand.off", "anchor.off", "pig.stl"}),
        128);
}
