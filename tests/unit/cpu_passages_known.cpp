// How near a sensor comes on its way, and when its last contact ends, where that is known in closed form.
#include <cmath>
#include <tuple>

#include "math/vector.h"
#include "radar/cpu_sweeper.h"
#include "radar/shapes.h"
#include "support/catch.h"
#include "support/world.h"
#include "workloads/shapes.h"

using namespace radar;
using test::add;
using test::at;
using tools::Vec3;

namespace {

/// A cube with this half side.
tools::MeshData cube(double half) {
  return tools::makeBox({2 * half, 2 * half, 2 * half});
}

}  // namespace

TEST_CASE("a cube that passes another one at an edge is nearest where the middles are level") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  scene.addObject({mesh, at(0, 0, 0)});
  Query query{.mesh = mesh, .worldFromMesh = at(-10, 5, 6), .direction = {1, 0, 0}, .distance = 40, .closest = true};
  const auto ask = [&] { return *CpuSweeper(scene, 1).run({&query, 1}).lists[0].closest; };
  Closest closest = ask();
  CHECK(closest.lo <= 5);
  CHECK(closest.hi >= 5);
  CHECK(closest.hi - closest.lo <= 1e-12);
  CHECK(closest.at.t >= 8 - 1e-12);
  CHECK(closest.at.t <= 12 + 1e-12);
  CHECK(closest.at.status == Status::clear);
  CHECK(std::abs(closest.at.normal[1] - 0.6) < 1e-12);
  // Not so far.
  query.distance = 4;
  closest = ask();
  CHECK(std::abs(closest.lo - std::sqrt(16 + 9 + 16.0)) < 1e-12);
  CHECK(closest.at.t == 4);
  // It is a pass of what it keeps clear of, whatever else is asked, and the surfaces' distance.
  query.distance = 40;
  query.clearance = 6;
  query.anyHit = true;
  CHECK(std::abs(ask().lo - 5) < 1e-12);
  query.exclude = {0};
  closest = ask();
  CHECK(std::isinf(closest.lo));
  CHECK(std::isinf(closest.hi));
  CHECK(closest.at.object == kNone);
}

TEST_CASE("what is near only amid the way, or only at its end, is nearest, though other objects are nearer elsewhere") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  scene.addObject({mesh, at(-10, 6, 0)});
  scene.addObject({mesh, at(30, 6, 0)});
  const ObjectId amid = scene.addObject({mesh, at(10, 5, 0)});
  const Query query{
      .mesh = mesh, .worldFromMesh = at(-10, 0, 0), .direction = {1, 0, 0}, .distance = 40, .closest = true};
  const auto ask = [&] { return *CpuSweeper(scene, 1).run({&query, 1}).lists[0].closest; };
  Closest closest = ask();
  CHECK(closest.lo <= 3);
  CHECK(closest.hi >= 3);
  CHECK(closest.at.object == amid);
  const ObjectId ahead = scene.addObject({mesh, at(33, 0, 0)});
  closest = ask();
  CHECK(closest.lo <= 1);
  CHECK(closest.hi >= 1);
  CHECK(closest.at.object == ahead);
}

TEST_CASE("what would touch just after the end of the way is not the last contact") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  const ObjectId passed = scene.addObject({mesh, at(0, 0, 0)});
  scene.addObject({mesh, at(20, 0, 0)});
  const Query query{.mesh = mesh,
                    .worldFromMesh = at(-10, 0, 0),
                    .direction = {1, 0, 0},
                    .distance = std::nextafter(28.0, 0.0),
                    .exit = true};
  const Result last = *CpuSweeper(scene, 1).run({&query, 1}).lists[0].exit;
  CHECK(last.status == Status::hit);
  CHECK(last.object == passed);
  CHECK(last.lo <= 12);
  CHECK(last.hi >= 12);
}

TEST_CASE("of grids that slide along each other, few pairs of triangles are looked at, however far the way leads") {
  Scene scene;
  const MeshId grid = add(scene, tools::makeGrid(32, tools::Diagonal::rising, [](uint32_t x, uint32_t y) {
                            return Vec3{0.125 * x, 0.125 * y, 0};
                          }));
  const auto [start, way, distance] = GENERATE(std::tuple{Vec3{0.05, 0, 0.3}, Vec3{1, 0.3, 0}, 3.0},
                                               std::tuple{Vec3{-8.2, 0.02, 0.3}, Vec3{1, 0, 0}, 16.0},
                                               std::tuple{Vec3{-8.2, 0.02, 0.3}, Vec3{1, 0.3, 0.01}, 1e308});
  CAPTURE(start[0], distance);
  scene.addObject({grid, at(0, 0, 0)});
  Query query{.mesh = grid, .worldFromMesh = tools::placedAt(start), .direction = way, .distance = distance};
  query.closest = true;
  const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
  const Closest& closest = *answers.lists[0].closest;
  CHECK(closest.lo >= 0.29);
  CHECK(closest.hi <= 0.4);
  CHECK(closest.hi - closest.lo < 1e-12);
  CHECK(answers.stats.pairs < 6000);
}

TEST_CASE("a step that ends a rounding before contact is that near, and not within less") {
  Scene scene;
  const MeshId mesh = scene.addMesh(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 1}, std::vector<uint32_t>{0, 1, 2});
  scene.addObject({mesh, at(1, 0, 0)});
  for (const double rest : {0x1p-20, 0x1p-40, 0x1p-45, 0x1p-50, 0x1p-52}) {
    CAPTURE(rest);
    Query query{.mesh = mesh, .motion = Vector{1 - rest, 0, 0}, .closest = true};
    const Closest closest = *CpuSweeper(scene, 1).run({&query, 1}).lists[0].closest;
    CHECK(closest.lo <= rest);
    CHECK(closest.hi >= rest);
    CHECK(closest.hi <= 1.001 * rest);
    query.closest = false;
    query.exit = true;
    query.clearance = 0.5 * rest;
    const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
    CHECK(answers.results[0].status != Status::hit);
    CHECK(answers.lists[0].exit->status != Status::hit);
  }
}

TEST_CASE("an exit at about the clearance from the end is not after the end") {
  Scene scene;
  const MeshId mesh = scene.addMesh(std::vector<float>{0, 0, 0, 0, 1, 0, 0, 0, 1}, std::vector<uint32_t>{0, 1, 2});
  scene.addObject({mesh, at(0, 0, 0)});
  for (int ulps = 0; ulps < 200; ++ulps) {
    Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 1 + ulps * 0x1p-52, .clearance = 1, .exit = true};
    const Result exit = *CpuSweeper(scene, 1).run({&query, 1}).lists[0].exit;
    CAPTURE(ulps, exit.lo, exit.hi);
    REQUIRE(exit.hi <= query.distance);
    REQUIRE(exit.hi >= 1);
    REQUIRE(exit.lo <= 1);
  }
}

TEST_CASE("what touches on its way has no distance, and its closest approach is the contact") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  scene.addObject({mesh, at(0, 0, 0)});
  for (const bool anyHit : {false, true}) {
    Query query{.mesh = mesh, .worldFromMesh = at(-10, 2, 0), .direction = {1, 0, 0}, .distance = 40, .anyHit = anyHit};
    query.closest = true;
    const Answers answers = CpuSweeper(scene, 1).run({&query, 1});
    const Closest& closest = *answers.lists[0].closest;
    CHECK(closest.lo == 0);
    CHECK(closest.hi == 0);
    CHECK(closest.at.status == Status::hit);
    CHECK(closest.at.t == 8);
    CHECK(closest.at.object == 0);
  }
}

TEST_CASE("the way out of what overlaps is where the last contact ends") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1)), wall = add(scene, tools::makeBox({10, 10, 1}));
  scene.addObject({wall, at(0, 0, 0)});
  Query query{.mesh = mesh, .worldFromMesh = at(0, 0, 0.25), .direction = {0, 0, 3}, .distance = 40, .exit = true};
  const auto ask = [&] { return *CpuSweeper(scene, 1).run({&query, 1}).lists[0].exit; };
  Result exit = ask();
  CHECK(exit.status == Status::hit);
  CHECK(exit.lo <= 1.25);
  CHECK(exit.hi >= 1.25);
  CHECK(exit.hi - exit.lo < 1e-14);
  CHECK(exit.object == 0);
  CHECK(exit.normal == Vec3{0, 0, 1});
  SECTION("an enclosed shape, without contact at the start, has one too") {
    query.worldFromMesh = tools::makePose({1, 0, 0, 0, 1, 0, 0, 0, 1}, {0.25, 0.25, 0.25}, {0, 0, 0});
    CHECK(std::abs(ask().hi - 0.75) < 1e-14);
  }
  SECTION("something later on the way counts, too") {
    scene.addObject({wall, at(0, 0, 20)});
    CHECK(std::abs(ask().hi - 21.25) < 1e-13);
    CHECK(ask().object == 1);
    query.exclude = {0, 1};
    CHECK(ask().status == Status::clear);
  }
  SECTION("a way that is too short ends in contact") {
    query.distance = 1;
    exit = ask();
    CHECK(exit.lo == 1);
    CHECK(exit.hi == 1);
    query.distance = 1.25;
    CHECK(ask().lo == 1.25);
  }
  SECTION("with a clearance, it is out when it is that far away") {
    query.clearance = 0.5;
    exit = ask();
    CHECK(exit.status == Status::hit);
    CHECK(exit.lo <= 1.75);
    CHECK(exit.hi >= 1.75);
    CHECK(exit.hi - exit.lo < 1e-11);
    CHECK(std::abs(exit.gap - 0.5) < 1e-11);
    query.distance = 1;
    CHECK(ask().lo == 1);
  }
  SECTION("a ball, too, and one that passes a face before it leaves an edge") {
    const RoundShape round = ball(2);
    query.mesh = scene.addMesh(round.positions, round.indices);
    query.clearance = round.radius;
    query.worldFromMesh = at(0, 6, 0);
    exit = ask();
    CHECK(std::abs(exit.lo - (0.5 + std::sqrt(3.0))) < 1e-11);
    CHECK(std::abs(exit.hi - (0.5 + std::sqrt(3.0))) < 1e-11);
    CHECK(exit.featureB == Feature::edge);
  }
  SECTION("objects that move are left relative to them") {
    scene.setMotion(0, {0, 0, -2});
    query.direction = {};
    query.distance = 0;
    query.motion = Vec3{0, 0, 3};
    exit = ask();
    CHECK(std::abs(exit.lo - 0.25) < 1e-15);
    CHECK(std::abs(exit.hi - 0.25) < 1e-15);
    query.clearance = 0.5;
    CHECK(std::abs(ask().hi - 0.35) < 1e-11);
    CHECK(std::abs(ask().lo - 0.35) < 1e-11);
  }
}

TEST_CASE("closest approach and exit are refused beside turns and what may leave") {
  Scene scene;
  const MeshId mesh = add(scene, cube(1));
  Query query{.mesh = mesh, .direction = {1, 0, 0}, .distance = 1, .ignoreLeaving = true, .closest = true};
  CHECK(validate(query, scene) == "closest: expected neither a turn nor ignoreLeaving beside it");
  query = {.mesh = mesh, .turn = Turn{{0, 0, 1}, 1, {}}, .exit = true};
  CHECK(validate(query, scene) == "exit: expected neither a turn nor ignoreLeaving beside it");
  query = {.mesh = mesh, .direction = {1, 0, 0}, .distance = 1, .exit = true};
  CHECK(validate(query, scene).empty());
  CHECK(validate(query, scene, Mode::sampled).find("got sampled") != std::string::npos);
}
