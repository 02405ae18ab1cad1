// Balls and capsules against closed forms: first contact at a distance, feature by feature, in long doubles.
#include "radar/shapes.h"

#include <algorithm>
#include <cmath>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "support/real_points.h"
#include "workloads/random.h"

using namespace radar;
using namespace radar::test;
using tools::Random;
using tools::Vec3;

namespace {

/// The first t of 0 or more at which p + t d is within r of q, if it is not before.
Real enters(const Point& p, const Point& d, const Point& q, Real r) {
  const Point w = p - q;
  const Real b = dot(w, d), c = dot(w, w) - r * r, root = b * b - dot(d, d) * c;
  return root < 0 || b >= 0 ? kNever : c / (-b + std::sqrt(root));
}

/// The same for the inside of a segment.
Real entersSide(const Point& p, const Point& d, const Point& from, const Point& to, Real r) {
  const Point e = to - from, w = p - from;
  const auto across = [&](const Point& x) { return x - dot(x, e) / dot(e, e) * e; };
  const Real t = enters(across(w), across(d), {}, r), at = dot(w + t * d, e) / dot(e, e);
  return t < kNever && at >= 0 && at <= 1 ? t : kNever;
}

/// The same for the inside of a triangle.
Real entersFace(const Point& p, const Point& d, const std::array<Point, 3>& corners, Real r) {
  Point n = cross(corners[1] - corners[0], corners[2] - corners[0]);
  n = 1 / std::sqrt(dot(n, n)) * n;
  if (dot(p - corners[0], n) < 0) n = -1 * n;
  if (dot(d, n) >= 0) return kNever;
  const Real t = (r - dot(p - corners[0], n)) / dot(d, n);
  for (size_t i = 0; i < 3; ++i) {
    const Point a = corners[i], edge = corners[(i + 1) % 3] - a, in = cross(n, edge);
    if (dot(p + t * d - a, in) * dot(corners[(i + 2) % 3] - a, in) < 0) return kNever;
  }
  return t < 0 ? kNever : t;
}

/// Two segments, both nearest inside, the first one moving.
Real entersCrossing(const std::array<Point, 2>& a, const Point& d, const std::array<Point, 2>& b, Real r) {
  const Point e = a[1] - a[0], f = b[1] - b[0];
  Point n = cross(e, f);
  n = 1 / std::sqrt(dot(n, n)) * n;
  if (dot(a[0] - b[0], n) < 0) n = -1 * n;
  if (dot(d, n) >= 0) return kNever;
  const Real t = (r - dot(a[0] - b[0], n)) / dot(d, n);
  const Point w = a[0] + t * d - b[0], m = cross(e, f);
  const Real u = dot(cross(f, w), m) / dot(m, m), v = dot(cross(e, w), m) / dot(m, m);
  return t >= 0 && u >= 0 && u <= 1 && v >= 0 && v <= 1 ? t : kNever;
}

/// A segment, or a point of two equal ends, that moves towards a triangle from farther away than r.
Real firstWithin(const std::array<Point, 2>& core, const Point& d, const std::array<Point, 3>& corners, Real r) {
  const bool isPoint = core[0] == core[1];
  Real first = kNever;
  for (const Point& end : core) {
    first = std::min(first, entersFace(end, d, corners, r));
    for (size_t i = 0; i < 3; ++i) {
      first = std::min({first, enters(end, d, corners[i], r), entersSide(end, d, corners[i], corners[(i + 1) % 3], r)});
    }
  }
  for (size_t i = 0; i < 3 && !isPoint; ++i) {
    first = std::min({first, entersSide(corners[i], -1 * d, core[0], core[1], r),
                      entersCrossing(core, d, {corners[i], corners[(i + 1) % 3]}, r)});
  }
  return first;
}

Point placed(const Transform& pose, const float* p) {
  const auto at = transformPoint(pose, p);
  return {at[0], at[1], at[2]};
}

/// A triangle (0, 0, 0), (4, 0, 0), (0, 4, 0), and a shape above it that moves down.
struct Plate {
  Scene scene;
  Query query{.direction = {0, 0, -1}, .distance = 9, .tolerance = 1e-12};
  Plate() {
    scene.addObject({scene.addMesh(std::vector<float>{0, 0, 0, 4, 0, 0, 0, 4, 0}, std::vector<uint32_t>{0, 1, 2})});
  }
  Plate& with(const RoundShape& shape, const Vec3& at) {
    query.mesh = scene.addMesh(shape.positions, shape.indices);
    query.worldFromMesh = tools::placedAt(at);
    query.clearance = shape.radius;
    return *this;
  }
  Answers answers() { return CpuSweeper(scene, 1).run({&query, 1}); }
  Result answer() { return answers().results[0]; }
  Result checkHit(double t) {
    const Result result = answer();
    REQUIRE(result.status == Status::hit);
    CHECK(result.lo <= t + 1e-13);
    CHECK(result.hi >= t - 1e-13);
    CHECK(result.hi - result.lo <= 1e-11);
    CHECK(std::abs(result.gap - query.clearance) < 1e-11);
    return result;
  }
  void checkHit(double t, Feature ofShape, Feature ofPlate) {
    const Result result = checkHit(t);
    CHECK(result.featureA == ofShape);
    CHECK(result.featureB == ofPlate);
  }
};

constexpr Feature kVertex = Feature::vertex, kEdge = Feature::edge, kFace = Feature::face;

}  // namespace

TEST_CASE("a ball touches a face, an edge and a vertex where a ball of that radius does") {
  Plate().with(ball(2), {1, 1, 5}).checkHit(3, kVertex, kFace);
  Plate().with(ball(2), {1, -1, 5}).checkHit(5 - std::sqrt(3.0), kVertex, kEdge);
  Plate().with(ball(3), {-1, -2, 5}).checkHit(3, kVertex, kVertex);
  CHECK(Plate().with(ball(2), {1, -2.001, 5}).answer().status == Status::clear);
  CHECK(Plate().with(ball(5.25), {1, 1, 5}).answer().status == Status::overlap);
}

TEST_CASE("a capsule touches with its side, with an end, and with both along a face") {
  // Across the edge y = 0.
  Plate().with(capsule({0, -3, 0}, {0, 2, 5}, 1), {1, 0, 6}).checkHit(9 - std::sqrt(2.0), kEdge, kEdge);
  Plate().with(capsule({0, 0, 0}, {0, 0, 3}, 1), {1, 1, 5}).checkHit(4, kVertex, kFace);
  Plate().with(capsule({0, 0, 0}, {1, 0, 0}, 1), {1, 1, 5}).checkHit(4);                     // along the face
  Plate().with(capsule({0, -3, 0}, {0, 3, 0}, 2), {-1, 0, 5}).checkHit(5 - std::sqrt(3.0));  // along an edge
  Plate().with(capsule({1, 2, 3}, {1, 2, 3}, 2), {0, -1, 2}).checkHit(3, kVertex, kFace);
}

TEST_CASE("a point touches as a vertex, and a segment as a vertex or an edge, never as a face") {
  const RoundShape point = ball(2), segment = capsule({0, 0, 0}, {2, 0, 0}, 2),
                   upright = capsule({0, 0, 0}, {0, 0, 3}, 2);
  for (const auto& [shape, at, own, other] : {std::tuple{point, Vec3{1, 1, 5}, kVertex, kFace},
                                              {point, Vec3{1, 0, 5}, kVertex, kEdge},
                                              {point, Vec3{4, 0, 5}, kVertex, kVertex},
                                              {upright, Vec3{1, 1, 5}, kVertex, kFace},
                                              {upright, Vec3{0, 1, 5}, kVertex, kEdge},
                                              {segment, Vec3{-1, 1, 5}, kEdge, kFace},
                                              {segment, Vec3{0.5, 1, 5}, kEdge, kFace},
                                              {segment, Vec3{-1, 4, 5}, kEdge, kVertex},
                                              {segment, Vec3{0.5, 0, 5}, kEdge, kEdge},
                                              {segment, Vec3{4, 0, 5}, kVertex, kVertex}}) {
    CAPTURE(at, shape.positions.size());
    const auto check = [&, a = own, b = other](const Result& result) {
      CHECK(result.featureA == a);
      CHECK(result.featureB == b);
    };
    Plate plate;
    Query& query = plate.with(shape, at).query;
    query.closest = query.exit = true;
    check(plate.answers().lists[0].closest->at);
    query.clearance = 0;
    check(plate.checkHit(5));
    check(*plate.answers().lists[0].exit);
    query.worldFromMesh.m[11] = 0;
    query.direction = {0, 0, 1};
    check(plate.answer());
    check(*plate.answers().lists[0].exit);
    check(plate.answers().lists[0].closest->at);
  }
}

TEST_CASE("a point that is touched is a vertex, and a segment an edge") {
  Scene scene;
  const MeshId plate = scene.addMesh(std::vector<float>{0, 0, 0, 4, 0, 0, 0, 4, 0}, std::vector<uint32_t>{0, 1, 2});
  const RoundShape point = ball(0), segment = capsule({0, 0, 0}, {2, 0, 0}, 0);
  scene.addObject({scene.addMesh(point.positions, point.indices), tools::placedAt({1, 1, -5})});
  scene.addObject({scene.addMesh(segment.positions, segment.indices), tools::placedAt({0.5, 1, -6})});
  const Query query{.mesh = plate, .direction = {0, 0, -1}, .distance = 9, .hits = kAllHits};
  const std::vector<Result> hits = CpuSweeper(scene, 1).run({&query, 1}).lists[0].hits;
  REQUIRE(hits.size() == 2);
  CHECK(hits[0].featureB == kVertex);
  CHECK(hits[0].featureA == kFace);
  CHECK(hits[0].point == Vec3{1, 1, -5});
  CHECK(hits[1].featureB == kEdge);
  CHECK(hits[1].featureA == kFace);
}

TEST_CASE("the radius is in world units, whatever the pose") {
  Plate plate;
  plate.with(ball(2), {1, 1, 5}).query.worldFromMesh.m[0] = 100;
  plate.checkHit(3, kVertex, kFace);
  Plate longer;
  longer.with(capsule({0, 0, 0}, {0, 0, 0.25}, 1), {1, 1, 5}).query.worldFromMesh.m[10] = -8;
  longer.checkHit(2, kVertex, kFace);
}

TEST_CASE("a rounded disc is a bull-nosed cutter") {
  const std::vector<float> square{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const std::vector<uint32_t> faces{0, 1, 2, 0, 2, 3};
  Plate().with(rounded(square, faces, 0.5), {3.2, 3.2, 5}).checkHit(5 - std::sqrt(0.25 - 0.08), kVertex, kEdge);
}

TEST_CASE("a ball may rest on what it leaves or slides along, and is blocked by what it comes nearer to") {
  for (const auto& [height, direction, status] : {std::tuple{2.0, Vec3{0, 0, 1}, Status::clear},
                                                  {2.0, Vec3{1, 0, 0}, Status::clear},
                                                  {1.5, Vec3{0, 0, 1}, Status::clear},
                                                  {1.5, Vec3{1, 0, -0.1}, Status::overlap},
                                                  {2.5, Vec3{0, 0, -1}, Status::hit}}) {
    CAPTURE(height, direction[0], direction[2]);
    Plate plate;
    plate.with(ball(2), {1, 1, height}).query.direction = direction;
    if (height < 2) CHECK(plate.answer().status == Status::overlap);
    plate.query.ignoreLeaving = true;
    CHECK(plate.answer().status == status);
  }
}

TEST_CASE("skipping what overlaps is about the core: a segment crosses a face, a point never does") {
  Plate crossing;
  crossing.with(capsule({0, 0, -1}, {0, 0, 1}, 0.5), {1, 1, 0}).query.skipOverlapping = true;
  const Answers answers = crossing.answers();
  CHECK(answers.results[0].status == Status::clear);
  CHECK(answers.lists[0].overlapping == std::vector<ObjectId>{0});
  Plate inside;
  inside.with(ball(0.5), {1, 1, 0}).query.skipOverlapping = true;
  CHECK(inside.answer().status == Status::overlap);
}

TEST_CASE("the hits of a ball are in the order in which it comes within its radius of objects") {
  Plate plate;
  const MeshId mesh = plate.scene.object(0).mesh;
  plate.scene.addObject({mesh, tools::placedAt({0, 0, 1})});
  plate.scene.addObject({mesh, tools::placedAt({5, 0, 1.5})});
  plate.with(ball(2), {1, 1, 6}).query.hits = kAllHits;
  const std::vector<Result> hits = plate.answers().lists[0].hits;
  REQUIRE(hits.size() == 2);  // the third is farther away than 2
  CHECK(hits[0].object == 1);
  CHECK(std::abs(hits[0].lo - 3) < 1e-11);
  CHECK(hits[1].object == 0);
  CHECK(std::abs(hits[1].lo - 4) < 1e-11);
  plate.query.hits = 1;
  plate.query.anyHit = true;
  CHECK(plate.answer().status == Status::hit);
}

TEST_CASE("random balls and capsules stop where closed forms say") {
  int hits = 0, clear = 0;
  for (uint64_t seed = 0; seed < 4000; ++seed) {
    CAPTURE(seed);
    Random random(seed);
    const double scale = random.magnitude(-3, 3), radius = scale * random.uniform(0.05, 1.5);
    const auto floats = [&] {
      std::array<float, 3> p{};
      const Vec3 at = random.inCube(scale);
      std::ranges::transform(at, p.begin(), [](double x) { return static_cast<float>(x); });
      return p;
    };
    const RoundShape shape = seed % 2 ? ball(radius) : capsule(floats(), floats(), radius);
    std::vector<float> corners;
    for (int i = 0; i < 3; ++i) {
      for (const float x : floats()) corners.push_back(x);
    }
    Scene scene;
    scene.addObject({scene.addMesh(corners, std::vector<uint32_t>{0, 1, 2}), random.affine({})});
    Query query{.mesh = scene.addMesh(shape.positions, shape.indices), .clearance = radius, .tolerance = 1e-9 * radius};
    query.worldFromMesh = random.affine({});
    const Vec3 away = random.direction(), aside = random.inCube(2 * scale);
    for (size_t k = 0; k < 3; ++k) {
      query.worldFromMesh.m[4 * k + 3] = 20 * scale * away[k];
      query.direction[k] = aside[k] - 20 * scale * away[k];
    }
    query.distance = 40 * scale;
    const Point d{query.direction[0], query.direction[1], query.direction[2]};
    const MeshView object = scene.mesh(0);
    std::array<Point, 3> triangle;
    for (size_t i = 0; i < 3; ++i) triangle[i] = placed(scene.object(0).worldFromMesh, &object.positions[3 * i]);
    const std::array<Point, 2> core{placed(query.worldFromMesh, shape.positions.data()),
                                    placed(query.worldFromMesh, &shape.positions[shape.positions.size() - 3])};
    const Real expected = firstWithin(core, d, triangle, radius) * std::sqrt(dot(d, d));
    const Result result = CpuSweeper(scene, 1).run({&query, 1}).results[0];
    if (expected == kNever) {
      REQUIRE(result.status == Status::clear);
      ++clear;
      continue;
    }
    REQUIRE(result.status == Status::hit);
    REQUIRE(result.lo <= expected + 1e-15 * scale);
    REQUIRE(result.hi >= expected - 1e-15 * scale);
    REQUIRE(result.hi - result.lo <= 1e-9 * radius);
    ++hits;
  }
  CHECK(hits > 1000);
  CHECK(clear > 500);
}

TEST_CASE("a radius or point that is no number is refused by name") {
  for (const double radius : {-1.0, double(NAN), double(INFINITY), 0x1p1001}) {
    CHECK_THROWS_WITH(ball(radius), test::StartsWith("ball: radius: expected a number from 0 to 2^1000, got "));
    CHECK_THROWS_WITH(capsule({}, {}, radius), test::StartsWith("capsule: radius: "));
    CHECK_THROWS_WITH(rounded({}, {}, radius), test::StartsWith("rounded: radius: "));
  }
  CHECK_THROWS_WITH(capsule({NAN, 0, 0}, {}, 1), test::StartsWith("capsule: expected two points of finite numbers"));
}
