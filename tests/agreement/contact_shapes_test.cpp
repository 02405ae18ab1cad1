// The search on the device against the CPU's in scenes made by hand.
#include <cmath>

#include "agreement/compare.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::compare;
using tools::MeshData;
using tools::Random;
using tools::Vec3;

constexpr std::array<double, 9> kUpright{1, 0, 0, 0, 1, 0, 0, 0, 1};
constexpr Vec3 kFull{1, 1, 1};

MeshId add(Scene& scene, const MeshData& mesh) {
  return scene.addMesh(mesh.positions, mesh.indices);
}

Transform at(const Vec3& place, const Vec3& scale = kFull) {
  return tools::makePose(kUpright, scale, place);
}

}  // namespace

TEST_CASE("boxes in one line touch at the start, in flight and at exactly the distance") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({1, 1, 1}));
  const ObjectId object = scene.addObject({box, at({0, 0, 4}), ~0u});
  const auto ask = [&](const Vec3& start, double distance) {
    return Query{.mesh = box, .worldFromMesh = at(start), .direction = {0, 0, 2}, .distance = distance};
  };
  std::vector<Query> queries{ask({0, 0, 0}, 3),
                             ask({0, 0, 0}, std::nextafter(3, 0)),
                             ask({0, 0, 0}, 10),
                             ask({0, 0, 3}, 1),
                             ask({0, 0, 3}, 0),
                             ask({0, 0, std::nextafter(3, 0)}, 0),
                             ask({0, 0, std::nextafter(3, 0)}, 1),
                             ask({0, 0, 4.5}, 5),
                             ask({0, 0, 5}, 5),
                             ask({0, 0, std::nextafter(5, 6)}, 5),
                             ask({1, 0, 0}, 9),
                             ask({std::nextafter(1, 2), 0, 0}, 9),
                             ask({1, 1, 0}, 9),
                             ask({1, 1, 0}, 3),
                             ask({1, 1, 3}, 0),
                             ask({-1, 0.5, 0}, 9)};
  compare(scene, queries);
  Sweeper sweeper(test::device(), scene, {.cpuBatch = 0});
  const std::vector<Result> results = sweeper.run(queries).results;
  CHECK((results[0].status == Status::hit && results[0].t == 3 && results[0].hi == 3));
  CHECK(results[0].object == object);
  CHECK(results[1].status == Status::clear);
  CHECK((results[2].status == Status::hit && results[2].t == 3));
  CHECK((results[3].status == Status::overlap && results[4].status == Status::overlap));
  CHECK(results[5].status == Status::clear);
  CHECK(results[6].status == Status::hit);
  CHECK((results[8].status == Status::overlap && results[9].status == Status::clear));
  CHECK((results[10].status == Status::hit && results[11].status == Status::clear));
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
    const Vec3 place = random.inBox({-4, -4, -4}, {4, 4, 4});
    return tools::makePose(random.rotation(), {scale, scale, scale},
                           {side * place[0], side * place[1], side * place[2]});
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
      4, {.mesh = ball, .worldFromMesh = at({-0.5, 0.25, -7}), .direction = {0, 0, 1}, .distance = 50});
  queries.push_back({.mesh = ball, .worldFromMesh = at({-1.25, 0.5, -7}), .direction = {0, 0, 1}, .distance = 50});
  for (int repeat = 0; repeat < 3; ++repeat) CHECK(compare(scene, queries).tally.hits == queries.size());
}

TEST_CASE("two poles of many triangles each meet in every pair at once, and the least is reported") {
  Scene scene;
  const MeshId ball = add(scene, tools::makeUvSphere(6, 40));
  scene.addObject({ball, {}, ~0u});
  scene.addObject({ball, {}, ~0u});
  const tools::Tally tally =
      compare(scene, {{.mesh = ball, .worldFromMesh = at({0, 0, -7}), .direction = {0, 0, 2}, .distance = 50},
                      {.mesh = ball, .worldFromMesh = at({0, 0, -7}), .direction = {0, 0, 2}, .distance = 5},
                      {.mesh = ball, .worldFromMesh = at({0, 0, -2}), .direction = {0, 0, 2}, .distance = 5}})
          .tally;
  CHECK(tally.hits == 2);
  CHECK(tally.overlaps == 1);
}
