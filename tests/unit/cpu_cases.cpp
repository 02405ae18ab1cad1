// Cases whose answers are known.
#include "support/answer.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using test::at;

namespace {

Query sweep(MeshId mesh, const Transform& pose, std::array<double, 3> direction, double distance) {
  Query query;
  query.mesh = mesh;
  query.worldFromMesh = pose;
  query.direction = direction;
  query.distance = distance;
  return query;
}

}  // namespace

TEST_CASE("a box that falls on another hits it after the gap between them") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const ObjectId lower = scene.addObject({box, at(0.25, 0.5, 0)});
  CpuSweeper sweeper(scene);
  const Result result = test::answer(sweeper, sweep(box, at(0, 0, 5), {0, 0, -2}, 10));
  REQUIRE(result.status == Status::hit);
  REQUIRE(result.t == 3);
  REQUIRE(result.lo <= 3);
  REQUIRE(result.hi >= 3);
  REQUIRE(result.fraction == 0.3);
  REQUIRE(result.object == lower);
  REQUIRE(result.point[2] == 1);
  REQUIRE(result.normal == std::array<double, 3>{0, 0, 1});
  REQUIRE(result.detected == Detected::yes);
}

TEST_CASE("contact at exactly D counts, and contact beyond D does not") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  scene.addObject({box, at(0, 0, 0)});
  CpuSweeper sweeper(scene);
  const Result touch = test::answer(sweeper, sweep(box, at(0, 0, 5), {0, 0, -1}, 3));
  REQUIRE(touch.status == Status::hit);
  REQUIRE(touch.t == 3);
  REQUIRE(touch.hi == 3);
  REQUIRE(touch.fraction == 1);
  const Result miss = test::answer(sweeper, sweep(box, at(0, 0, 5), {0, 0, -1}, std::nextafter(3.0, 0.0)));
  REQUIRE(miss.status == Status::clear);
  REQUIRE(miss.hi == INFINITY);
}

TEST_CASE("touching at the start is an overlap at zero") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  scene.addObject({box, at(0, 0, 0)});
  CpuSweeper sweeper(scene);
  for (double distance : {0.0, 5.0}) {
    for (double away : {-1.0, 1.0}) {
      const Result result = test::answer(sweeper, sweep(box, at(0, 0, 2), {0, 0, away}, distance));
      REQUIRE(result.status == Status::overlap);
      REQUIRE(result.t == 0);
      REQUIRE(result.lo == 0);
      REQUIRE(result.hi == 0);
      REQUIRE(result.fraction == 0);
    }
  }
}

TEST_CASE("an edge-on plate is hit on its rim") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const MeshId plate = add(scene, {"", {0, 0, -3, 0, 0, 3, 0, 8, -3, 0, 8, 3}, {0, 1, 2, 2, 1, 3}});
  scene.addObject({plate, at(0.25, 2, 0)});
  CpuSweeper sweeper(scene);
  const Result result = test::answer(sweeper, sweep(box, at(0, 0, 0), {0, 1, 0}, 10));
  REQUIRE(result.status == Status::hit);
  REQUIRE(result.t == 1);
  const Result reverse = test::answer(sweeper, sweep(box, at(0, 20, 0), {0, -1, 0}, 10));
  REQUIRE(reverse.t == 9);
}

TEST_CASE("two plates in one plane meet at their rims") {
  Scene scene;
  const MeshId plate = add(scene, {"", {0, 0, 0, 0, 1, 0, 0, 0, 1}, {0, 1, 2}});
  scene.addObject({plate, at(0, 4, 0)});
  CpuSweeper sweeper(scene);
  REQUIRE(test::answer(sweeper, sweep(plate, at(0, 0, 0), {0, 1, 0}, 10)).t == 3);
  REQUIRE(test::answer(sweeper, sweep(plate, at(1e-9, 0, 0), {0, 1, 0}, 10)).status == Status::clear);
}

TEST_CASE("a mesh that moves inside another without reaching its surface is clear") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const MeshId hall = add(scene, tools::makeBox({20, 20, 20}));
  scene.addObject({hall, Transform{}});
  CpuSweeper sweeper(scene);
  REQUIRE(test::answer(sweeper, sweep(box, Transform{}, {1, 0, 0}, 8)).status == Status::clear);
  REQUIRE(test::answer(sweeper, sweep(box, Transform{}, {1, 0, 0}, 9)).t == 9);
}

TEST_CASE("the object behind is found when the one in front is excluded or masked") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const ObjectId front = scene.addObject({box, at(0, 0, 5), 1});
  const ObjectId back = scene.addObject({box, at(0, 0, 9), 2});
  CpuSweeper sweeper(scene);
  Query query = sweep(box, Transform{}, {0, 0, 1}, 20);
  REQUIRE(test::answer(sweeper, query).object == front);
  query.exclude = {front};
  REQUIRE(test::answer(sweeper, query).object == back);
  query.exclude.clear();
  query.mask = 2;
  REQUIRE(test::answer(sweeper, query).object == back);
  query.mask = 4;
  REQUIRE(test::answer(sweeper, query).status == Status::clear);
}

TEST_CASE("of many objects hit at the same time the one with the lowest id is reported") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  const MeshId plank = add(scene, tools::makeBox({80, 2, 2}));
  for (int i = 0; i < 20; ++i) scene.addObject({box, at(3.0 * ((7 * i) % 20) - 30, 0, 5)});
  CpuSweeper sweeper(scene);
  const Result result = test::answer(sweeper, sweep(plank, Transform{}, {0, 0, 1}, 20));
  REQUIRE(result.t == 3);
  REQUIRE(result.object == 0);
  REQUIRE(result.triB == 0);
}

TEST_CASE("the CPU follows edits of the scene") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  CpuSweeper sweeper(scene);
  const Query query = sweep(box, Transform{}, {0, 0, 1}, 20);
  REQUIRE(test::answer(sweeper, query).status == Status::clear);
  const ObjectId first = scene.addObject({box, at(0, 0, 10)});
  REQUIRE(test::answer(sweeper, query).t == 8);
  const ObjectId second = scene.addObject({box, at(0, 0, 6)});
  REQUIRE(test::answer(sweeper, query).t == 4);
  scene.setTransform(second, at(0, 0, 12));
  REQUIRE(test::answer(sweeper, query).object == first);
  scene.removeObject(first);
  REQUIRE(test::answer(sweeper, query).t == 10);
  scene.removeObject(second);
  REQUIRE(test::answer(sweeper, query).status == Status::clear);
  // The id of a removed mesh now names another mesh.
  scene.removeMesh(box);
  const MeshId tall = add(scene, tools::makeBox({2, 2, 6}));
  REQUIRE(tall == box);
  scene.addObject({tall, at(0, 0, 10)});
  REQUIRE(test::answer(sweeper, query).t == 4);
}

TEST_CASE("the CPU refuses a query that breaks its contract") {
  Scene scene;
  const MeshId box = add(scene, tools::makeBox({2, 2, 2}));
  scene.addObject({box, Transform{}});
  CpuSweeper sweeper(scene);
  REQUIRE_THROWS_AS(test::answer(sweeper, sweep(box, Transform{}, {0, 0, 0}, 1)), Error);
  REQUIRE_THROWS_AS(test::answer(sweeper, sweep(box, Transform{}, {0, 0, 1}, -1)), Error);
  REQUIRE_THROWS_AS(test::answer(sweeper, sweep(box + 1, Transform{}, {0, 0, 1}, 1)), Error);
}
