// The search on the device against the CPU's in scenes made by hand.
#include <cmath>

#include "agreement/compare.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "unit/known_cases.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::add;
using test::at;
using test::compare;
using tools::MeshData;
using tools::Random;
using tools::Vec3;

}  // namespace

TEST_CASE("the device gives the known answers about boxes among boxes") {
  known::check([](const Scene& scene, const std::vector<Query>& queries) {
    return Sweeper(test::device(), scene, {.cpuBatch = 0}).run(queries).results;
  });
}

TEST_CASE("meshes in units so small or large that float cannot hold their poses meet as the CPU says") {
  const auto [unit, world] = GENERATE(table<double, double>({{1e-30, 1e12}, {1e25, 1e-18}, {1e20, 1e-21}, {1, 1}}));
  CAPTURE(unit, world);
  Random random(7);
  Scene scene;
  MeshData ball = tools::makeUvSphere(6, 9);
  for (float& x : ball.positions) x = static_cast<float>(x * unit);
  const MeshId mesh = add(scene, ball);
  const double scale = world / unit;
  const auto pose = [&, side = world] {
    return tools::makePose(random.rotation(), {scale, scale, scale}, random.inCube(4 * side));
  };
  for (int i = 0; i < 8; ++i) scene.addObject({mesh, pose(), ~0u});
  std::vector<Query> queries;
  queries.reserve(48);
  for (int i = 0; i < 48; ++i) {
    queries.push_back({.mesh = mesh, .worldFromMesh = pose(), .direction = random.direction(), .distance = 12 * world});
  }
  const tools::Tally tally = compare(scene, queries).tally;
  CHECK(tally.hits >= 5);
  CHECK(tally.clear >= 5);
}

TEST_CASE("two balls of many triangles meet as the CPU says, however often they are asked") {
  const uint32_t rings = GENERATE(100, 140, 180);
  CAPTURE(rings);
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(rings, 2 * rings));
  scene.addObject({ball, {}, ~0u});
  // A search of many rounds.
  std::vector<Query> queries(
      4, {.mesh = ball, .worldFromMesh = at(-0.5, 0.25, -7), .direction = {0, 0, 1}, .distance = 50});
  queries.push_back({.mesh = ball, .worldFromMesh = at(-1.25, 0.5, -7), .direction = {0, 0, 1}, .distance = 50});
  for (int repeat = 0; repeat < 3; ++repeat) CHECK(compare(scene, queries).tally.hits == queries.size());
}

TEST_CASE("two poles of many triangles each meet in every pair at once, and the least is reported") {
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(6, 40));
  scene.addObject({ball, {}, ~0u});
  scene.addObject({ball, {}, ~0u});
  const tools::Tally tally =
      compare(scene, {{.mesh = ball, .worldFromMesh = at(0, 0, -7), .direction = {0, 0, 2}, .distance = 50},
                      {.mesh = ball, .worldFromMesh = at(0, 0, -7), .direction = {0, 0, 2}, .distance = 5},
                      {.mesh = ball, .worldFromMesh = at(0, 0, -2), .direction = {0, 0, 2}, .distance = 5}})
          .tally;
  CHECK(tally.hits == 2);
  CHECK(tally.overlaps == 1);
}
