// The CPU's search follows its scene, and CpuSweeper keeps its contract.
#include "radar/cpu_sweeper.h"
#include "soups.h"
#include "support/catch.h"
#include "support/same_bits.h"

using namespace radar;
using soups::Random;
using test::add;
using tools::operator*;

namespace {

std::vector<Query> queriesThrough(Random& random, const std::vector<MeshId>& meshes) {
  std::vector<Query> queries(20);
  for (Query& query : queries) {
    query.mesh = meshes[random.below(static_cast<uint32_t>(meshes.size()))];
    query.worldFromMesh = random.pose(random.uniform(0.3, 1), 5 * random.inBall());
    query.direction = random.inBall();
    query.distance = random.uniform(0, 10);
  }
  return queries;
}

Transform somewhere(Random& random) {
  return random.pose(random.uniform(0.3, 1.5), 4 * random.inBall());
}

MeshId addSoup(Random& random, Scene& scene) {
  return add(scene, soups::soup(random, random.integer(1, 30), random.uniform(0.1, 0.7), 0.1));
}

}  // namespace

TEST_CASE("the CPU's answers follow a scene to which another is move-assigned") {
  Random random(12);
  Scene scene;
  std::vector<MeshId> meshes{addSoup(random, scene), addSoup(random, scene)};
  for (int i = 0; i < 5; ++i) scene.addObject({meshes[0], somewhere(random)});
  CpuSweeper sweeper(scene, 2);
  sweeper.run(queriesThrough(random, meshes));
  for (int round = 0; round < 10; ++round) {
    Scene other;
    meshes = {addSoup(random, other), addSoup(random, other), addSoup(random, other)};
    for (int i = random.integer(0, 8); i-- > 0;) {
      other.addObject({meshes[random.below(3)], somewhere(random)});
    }
    if (random.chance(0.5)) CpuSweeper(other, 1).sync();
    scene = std::move(other);
    const std::vector<Query> queries = queriesThrough(random, meshes);
    REQUIRE(test::differenceOf(sweeper.run(queries), CpuSweeper(scene).run(queries)) == "");
  }
}

TEST_CASE("the CPU finds contact of meshes so small that the inverse of their size overflows a float") {
  Scene scene;
  tools::MeshData small = tools::makeBox({2, 2, 2});
  for (float& c : small.positions) c *= 0x1p-140f;
  const MeshId mesh = add(scene, small);
  Transform large;
  large.m = {0x1p140, 0, 0, 0, 0, 0x1p140, 0, 0, 0, 0, 0x1p140, 5};
  scene.addObject({mesh, large});
  large.m[11] = 0;
  Query query;
  query.mesh = mesh;
  query.worldFromMesh = large;
  query.direction = {0, 0, 1};
  query.distance = 10;
  const Result result = CpuSweeper(scene, 1).run({&query, 1}).results[0];
  REQUIRE(result.status == Status::hit);
  REQUIRE(result.t == 3);
}

TEST_CASE("the CPU answers no query of a batch in which one breaks its contract, and names that one") {
  Scene scene;
  const Query good{.mesh = add(scene, tools::makeBox({2, 2, 2})), .direction = {1, 0, 0}, .distance = 1};
  CpuSweeper sweeper(scene);
  for (const auto& [bad, words] :
       {std::pair{Query{.mesh = good.mesh, .direction = {1, 0, 0}, .distance = -1}, "query 1: distance"},
        {Query{.mesh = good.mesh, .distance = 1}, "query 1: direction"},
        {Query{.mesh = good.mesh + 1, .direction = {1, 0, 0}}, "query 1: sensor: mesh 1 does not exist"}}) {
    CHECK_THROWS_WITH(sweeper.run(std::vector{good, bad, good}), test::Contains(words));
  }
  CHECK(sweeper.run(std::vector{good, good, good}).results.size() == 3);
  CHECK(sweeper.run({}).results.empty());
}

TEST_CASE("positions that a mesh cannot take are refused") {
  Scene scene;
  const tools::MeshData box = tools::makeBox({2, 2, 2});
  const MeshId mesh = add(scene, box);
  const MeshId bounded = scene.addMesh(box.positions, box.indices, Bounds{{-2, -2, -2}, {2, 2, 2}});
  std::vector<float> positions = box.positions;
  CHECK_THROWS_WITH(scene.setPositions(9, positions), test::Contains("mesh 9 does not exist"));
  positions[4] = 2;
  scene.setPositions(bounded, positions);
  positions[4] = std::nextafter(2.0f, 3.0f);
  CHECK_THROWS_WITH(scene.setPositions(bounded, positions), test::Contains("vertex 1 is outside the mesh's bounds"));
  positions[5] = NAN;
  CHECK_THROWS_WITH(scene.setPositions(mesh, positions), test::Contains("vertex 1 is not finite"));
  positions.pop_back();
  CHECK_THROWS_WITH(scene.setPositions(mesh, positions), test::Contains("expected 24 floats"));
}
