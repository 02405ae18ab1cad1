// A box at rest among others, which it may leave, slide along or push: named cases of queries that ignore what they
// leave.
#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/shapes.h"

using namespace radar;
using test::at;

namespace {

/// A floor below z = 0, a wall beyond x = 3 and a unit cube that rests on the floor with its corner at the origin.
struct Room {
  Scene scene;
  MeshId box = test::add(scene, tools::makeBox({1, 1, 1}));

  ObjectId add(std::array<double, 3> from, std::array<double, 3> to) {
    Transform pose;
    for (size_t k = 0; k < 3; ++k) {
      pose.m[5 * k] = to[k] - from[k];
      pose.m[4 * k + 3] = 0.5 * (from[k] + to[k]);
    }
    return scene.addObject({box, pose});
  }

  Result move(std::array<double, 3> direction, double distance = 10) {
    Query query{.mesh = box, .worldFromMesh = at(0.5, 0.5, 0.5), .direction = direction, .distance = distance};
    query.ignoreLeaving = true;
    return CpuSweeper(scene, 1).run({&query, 1}).results[0];
  }
};

}  // namespace

TEST_CASE("a box at rest may be lifted and pushed along the floor, but neither down nor through a wall") {
  Room room;
  room.add({-9, -9, -1}, {9, 9, 0});
  const ObjectId wall = room.add({3, -9, 0}, {4, 9, 9});
  REQUIRE(room.move({0, 0, 1}).status == Status::clear);
  REQUIRE(room.move({-1, 0, 0}, 5).status == Status::clear);
  REQUIRE(room.move({0, 0, -1}).status == Status::overlap);
  REQUIRE(room.move({1, 0, -1e-9}).status == Status::overlap);
  for (const std::array<double, 3> direction : {std::array{1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}, {1.0, 0.0, 1.0}}) {
    const Result result = room.move(direction);
    REQUIRE(result.status == Status::hit);
    REQUIRE(result.object == wall);
    REQUIRE(result.fraction * 10 * direction[0] / std::hypot(direction[0], direction[2]) == Approx(2));
  }
}

TEST_CASE("an edge that is only grazed does not hide the wall behind it") {
  Room room;
  room.add({1, 1, -9}, {2, 2, 9});  // touched along one edge, and left along its face
  const ObjectId wall = room.add({5, -9, -9}, {6, 9, 9});
  const Result result = room.move({1, 0, 0});
  REQUIRE(result.object == wall);
  REQUIRE(result.t == 4);
}

TEST_CASE("walls in one plane let a box slide along both") {
  Room room;
  room.add({-9, -1, -9}, {1, 0, 9});
  room.add({1, -1, -9}, {9, 0, 9});
  REQUIRE(room.move({1, 0, 0}, 5).status == Status::clear);
  REQUIRE(room.move({1, -1e-3, 0}, 5).status == Status::overlap);
}

TEST_CASE("a peg that fits a hole exactly moves along its axis only") {
  Room room;
  room.add({-9, -9, -9}, {0, 9, 9});
  room.add({1, -9, -9}, {9, 9, 9});
  room.add({0, -9, -9}, {1, 0, 9});
  room.add({0, 1, -9}, {1, 9, 9});
  REQUIRE(room.move({0, 0, 1}).status == Status::clear);
  REQUIRE(room.move({0, 0, -1}).status == Status::clear);
  REQUIRE(room.move({1, 0, 0}).status == Status::overlap);
  REQUIRE(room.move({0, -1, 0}).status == Status::overlap);
  REQUIRE(room.move({1e-6, 0, 1}).status == Status::overlap);
}

TEST_CASE("a body inside a cavity meets the cavity's wall from inside") {
  Room room;
  const ObjectId shell = room.add({-2, -2, -2}, {3, 3, 3});
  const Result result = room.move({0, 1, 0});
  REQUIRE(result.object == shell);
  REQUIRE(result.t == 2);
}

TEST_CASE("objects that cross the sensor are skipped and listed, those that touch it are not") {
  Room room;
  const ObjectId crossing = room.add({0.5, 0.5, 0.5}, {2, 2, 2});
  const ObjectId resting = room.add({-9, -9, -1}, {9, 9, 0});
  const ObjectId wall = room.add({3, -9, -9}, {4, 9, 9});
  Query query{.mesh = room.box, .worldFromMesh = at(0.5, 0.5, 0.5), .direction = {1, 0, 0}, .distance = 10};
  query.ignoreLeaving = query.skipOverlapping = true;
  CpuSweeper sweeper(room.scene, 1);
  const Answers answers = sweeper.run({&query, 1});
  REQUIRE(answers.results[0].object == wall);
  REQUIRE(answers.results[0].t == 2);
  REQUIRE(answers.lists[0].overlapping == std::vector{crossing});

  query.ignoreLeaving = false;  // then the floor, which is only touched, ends the motion
  REQUIRE(sweeper.run({&query, 1}).results[0].object == resting);
}

TEST_CASE("equal boxes stacked exactly let each other go upwards only") {
  Room room;
  room.add({0, 0, -1}, {1, 1, 0});
  for (const auto& [direction, status] : {std::pair{std::array{0.0, 0.0, 1.0}, Status::clear},
                                          {std::array{1.0, 0.0, 0.0}, Status::clear},
                                          {std::array{1.0, 1.0, 0.0}, Status::clear},
                                          {std::array{0.0, 0.0, -1.0}, Status::overlap},
                                          {std::array{1.0, 0.0, -1.0}, Status::overlap}}) {
    REQUIRE(room.move(direction).status == status);
  }
}
