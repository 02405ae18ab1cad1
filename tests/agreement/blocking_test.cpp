// Queries that ignore what does not block: the device searches most of them alone.
#include "support/catch.h"
#include "support/test_device.h"
#include "support/world.h"
#include "unit/soups.h"
#include "workloads/voxels.h"

using namespace radar;
using test::add;

TEST_CASE("a body on a fine floor is answered by the device alone") {
  if (!test::device().doubles()) return;
  // Two floors of 20 x 20 squares: 800 triangles each, in one plane, under a box of 4 x 4 squares.
  tools::Solid floor, box;
  for (int x = 0; x < 20; ++x) {
    for (int y = 0; y < 20; ++y) floor.insert({x, y, -1});
  }
  for (int x = 8; x < 12; ++x) {
    for (int y = 8; y < 12; ++y) box.insert({x, y, 0});
  }
  soups::Random random(1);
  Scene scene;
  const Transform rest = random.pose(0.7, {5, -3, 2});
  scene.addObject({add(scene, tools::boundaryOf(floor, random)), rest});
  const MeshId mesh = add(scene, tools::boundaryOf(box, random));
  std::vector<Query> queries;
  for (int i = 0; i < 32; ++i) {
    Query query{.mesh = mesh, .worldFromMesh = rest, .distance = 30};
    query.direction = tools::turned(tools::linearPart(rest), random.inBox({-1, -1, 0.001}, {1, 1, 1}));
    query.ignoreLeaving = true;
    queries.push_back(query);
  }
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  const Answers answers = sweeper.run(queries);
  for (const Result& result : answers.results) REQUIRE(result.status == Status::clear);
  REQUIRE(answers.stats.cpuQueries == 0);
  REQUIRE(answers.stats.cpuPairs == 0);
}
