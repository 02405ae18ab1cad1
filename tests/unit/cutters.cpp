// What queries, scenes and answers make of cutters.
#include "radar/cutters.h"

#include <cmath>

#include "cutter_kinds.h"
#include "support/catch.h"

using namespace radar;
using test::oneTriangle;
using tools::Vec3;

namespace {

/// A level plate at z = 0 below a flat cutter at z = 5.
struct Plate {
  Scene scene;
  Query query{.worldFromMesh = tools::placedAt({1, 1, 5}), .direction = {0, 0, -1}, .distance = 9};
  MeshId mesh;
  explicit Plate(const Cutter& cutter = flatCutter(1, 3))
      : mesh(scene.addMesh(std::vector<float>{-9, -9, 0, 9, -9, 0, 0, 9, 0}, oneTriangle())) {
    scene.addObject({mesh});
    query.mesh = scene.addCutter(cutter);
  }
  Answers answers() const { return CpuSweeper(scene, 1).run({&query, 1}); }
  Result answer() const { return answers().results[0]; }
};

}  // namespace

TEST_CASE("a cutter's answer names the object's triangle and feature, the point, the normal and the part") {
  Cutter tool = ballCutter(1, 3);
  tool.parts.push_back({{3, 2}, {6, 2}});
  Plate plate(tool);
  Result result = plate.answer();
  CHECK(result.triB == 0);
  CHECK(result.triA == 0);
  CHECK(result.featureB == Feature::face);
  CHECK(result.featureA == Feature::none);
  CHECK(std::abs(result.t - 5) < 1e-12);
  CHECK(std::abs(result.point[0] - 1) < 1e-12);
  CHECK(result.normal == std::array<double, 3>{0, 0, 1});
  CHECK(result.fraction == Approx(5.0 / 9));
  // The shank comes down on a wall's corner.
  plate.scene.addObject({plate.scene.addMesh(std::vector<float>{2.5, 1, 3.5, 3.5, 1, 1, 3.5, 2, 1}, oneTriangle())});
  result = plate.answer();
  CHECK(result.object == 1);
  CHECK(result.triA == 1);
  CHECK(result.featureB == Feature::vertex);
  CHECK(result.point == std::array<double, 3>{2.5, 1, 3.5});
  CHECK(std::abs(result.t - 4.5) < 1e-12);
}

TEST_CASE("what is inside a cutter at the start overlaps it, and what it leaves behind does not") {
  Plate plate;
  for (const auto& [height, up, status] : {std::tuple{-1.0, -1.0, Status::overlap},
                                           {-1.0, 1.0, Status::overlap},
                                           {0.001, 1.0, Status::clear},
                                           {0.001, -1.0, Status::hit},
                                           {-3.001, -1.0, Status::clear}}) {
    CAPTURE(height, up);
    plate.query.worldFromMesh.m[11] = height;
    plate.query.direction = {0.25, 0, up};
    CHECK(plate.answer().status == status);
  }
  plate.query.worldFromMesh.m[11] = -1;
  plate.scene.addObject({plate.mesh, tools::placedAt({0, 0, 0.5})});
  plate.query.hits = kAllHits;
  const Answers answers = plate.answers();
  CHECK(answers.results[0].object == 0);
  REQUIRE(answers.lists[0].hits.size() == 2);
  CHECK(std::abs(answers.lists[0].hits[1].point[2] - 0.5) < 1e-12);
}

TEST_CASE("a cutter takes masks, exclusions, lists, clearances and steps") {
  Plate plate;
  plate.scene.addObject({plate.mesh, tools::placedAt({0, 0, 1}), 2});
  CHECK(std::abs(plate.answer().t - 4) < 1e-12);
  plate.query.mask = 1;
  CHECK(std::abs(plate.answer().t - 5) < 1e-12);
  plate.query.mask = ~0u;
  plate.query.exclude = {1};
  CHECK(std::abs(plate.answer().t - 5) < 1e-12);
  plate.query.exclude = {};
  plate.query.hits = 2;
  const std::vector<Result> hits = plate.answers().lists[0].hits;
  REQUIRE(hits.size() == 2);
  CHECK(hits[0].object == 1);
  CHECK(std::abs(hits[1].t - 5) < 1e-12);
  plate.query.hits = 1;
  plate.query.anyHit = true;
  CHECK(plate.answer().status == Status::hit);
  plate.query.distance = 3.9;
  CHECK(plate.answer().status == Status::clear);
  plate.query.anyHit = false;
  plate.query.clearance = 0.5;
  const Result near = plate.answer();
  CHECK(std::abs(near.t - 3.5) < 1e-12);
  CHECK(near.gap == 0.5);
  plate.query.clearance = 0;
  plate.query.direction = {};
  plate.query.distance = 0;
  plate.query.motion = {{0, 0, -4}};
  plate.scene.setMotion(1, {0, 0, 4});
  const Result met = plate.answer();
  CHECK(std::abs(met.t - 0.5) < 1e-12);
  CHECK(std::abs(met.point[2] - 3) < 1e-12);
  plate.scene.setMotion(1, {0, 0, -4});
  CHECK(plate.answer().status == Status::clear);
}

TEST_CASE("what a cutter cannot do is refused by name") {
  Plate plate;
  const MeshId cutter = plate.query.mesh;
  CHECK_THROWS_WITH(plate.scene.addObject({cutter}), test::Contains("is a cutter, which only queries move"));
  CHECK_THROWS_WITH(plate.scene.setPositions(cutter, plate.scene.mesh(cutter).positions),
                    test::Contains("is a cutter"));
  const auto refusal = [&](auto change) {
    Query query = plate.query;
    change(query);
    return validate(query, plate.scene);
  };
  CHECK_THAT(refusal([](Query& q) { q.worldFromMesh.m[0] = 2; }), test::Contains("a cutter: expected a rigid pose"));
  CHECK_THAT(refusal([](Query& q) { q.ignoreLeaving = true; }), test::Contains("with a cutter"));
  CHECK_THAT(refusal([](Query& q) { q.skipOverlapping = true; }), test::Contains("with a cutter"));
  CHECK_THAT(refusal([](Query& q) { q.closest = true; }), test::Contains("with a cutter"));
  CHECK_THAT(refusal([](Query& q) { q.exit = true; }), test::Contains("with a cutter"));
  CHECK_THAT(refusal([](Query& q) {
               q.direction = {};
               q.distance = 0;
               q.turn = Turn{{0, 0, 1}, 1, {}};
             }),
             test::Contains("turn: expected none with a cutter"));
  CHECK_THAT(validate(plate.query, plate.scene, Mode::sampled), test::Contains("expected contact with a cutter"));
  for (const double wrong : {0.0, -1.0, double(NAN), double(INFINITY)}) {
    CHECK_THROWS_WITH(flatCutter(wrong, 1), test::StartsWith("flatCutter: radius: expected a number above 0"));
    CHECK_THROWS_WITH(flatCutter(1, wrong), test::StartsWith("flatCutter: length: "));
    CHECK_THROWS_WITH(coneCutter(1, wrong, 9), test::StartsWith("coneCutter: angle: "));
  }
  CHECK_THROWS_WITH(ballCutter(1, 1.5), test::StartsWith("ballCutter: length: expected at least twice the radius"));
  CHECK_THROWS_WITH(bullNoseCutter(1, 0.5, 0.9), test::Contains("length: expected at least twice the corner"));
  CHECK_THROWS_WITH(taperCutter(1, 1.3, 0.25, 0.4), test::Contains("where the cone and the ball end"));
  CHECK_THROWS_WITH(bullNoseCutter(1, 2, 9), test::StartsWith("bullNoseCutter: corner: "));
  CHECK_THROWS_WITH(coneCutter(1, 0.1, 9, 1), test::StartsWith("coneCutter: tipRadius: "));
  CHECK_THROWS_WITH(coneCutter(1, 0.1, 9), test::Contains("where the cone ends"));
  CHECK_THROWS_WITH(taperCutter(1, 0.5, 0.95, 9), test::Contains("so that the cone is wider"));
  CHECK_THROWS_WITH(plate.scene.addCutter({}), test::StartsWith("addCutter: parts: expected one or more"));
  CHECK_THROWS_WITH(plate.scene.addCutter({{{{0, 1}}}}),
                    test::StartsWith("addCutter: parts[0]: expected rings that span a solid"));
  CHECK_THROWS_WITH(plate.scene.addCutter({{{{0, -1}, {1, 1}}}}),
                    test::Contains("parts[0][0]: radius: expected 0 to 2^100"));
}
