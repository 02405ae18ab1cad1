// Meshes that people made, as sensors and as scenes: from assimp's test models and CGAL's data, in several formats.
#include <catch2/catch.hpp>

#include "agreement/compare.h"
#include "agreement/real_meshes.h"
#include "workloads/generate.h"

namespace {

using namespace radar;

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
  check(test::assimpModels(), 128);
}

TEST_CASE("CGAL's meshes, closed and with holes, knotted and convoluted, sweep through each other") {
  check(test::cgalMeshes(), 128);
}
