// Cutters against closed forms, and against proofs of each answer, in long doubles.
#include "radar/cutters.h"

#include <algorithm>
#include <cmath>

#include "radar/cpu_sweeper.h"
#include "support/catch.h"
#include "workloads/random.h"

using namespace radar;
using tools::Random;
using tools::Vec3;

namespace {

using Real = long double;
using Point = std::array<Real, 3>;
using Corners = std::array<Point, 3>;

constexpr Real kNever = INFINITY;

Real dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
Point along(const Point& p, Real t, const Point& d) {
  return {p[0] + t * d[0], p[1] + t * d[1], p[2] + t * d[2]};
}
Point minus(const Point& a, const Point& b) {
  return along(a, -1, b);
}

/// A cutter by its numbers, and its lower surface by the formula of its kind.
struct Kind {
  const char* name;
  Real radius, corner, tip, angle, length;
  Cutter cutter;

  /// Height of the surface over the tip, `out` from the axis, up to the radius.
  Real height(Real out) const {
    const Real bend = std::max<Real>(out - (radius - corner), 0);
    const Real round = corner > 0 ? corner - std::sqrt(std::max<Real>(corner * corner - bend * bend, 0)) : 0;
    if (angle == 0) return round;
    const Real touch = tip * std::cos(angle);  // of a taper's ball
    if (corner == 0) return std::max<Real>(out - tip, 0) / std::tan(angle);
    return out < touch ? tip - std::sqrt(tip * tip - out * out)
                       : tip - tip * std::sin(angle) + (out - touch) / std::tan(angle);
  }
  bool holds(const Point& p, Real room) const {
    const Real out = std::hypot(p[0], p[1]);
    return out <= radius + room && p[2] <= length + room && p[2] >= height(std::min(out, radius)) - room;
  }
};

Kind kindOf(Random& random, int which) {
  const double r = random.uniform(0.3, 3), length = r + random.uniform(4, 9), corner = r * random.uniform(0.05, 0.95);
  const double angle = random.uniform(0.15, 1.3), tip = r * random.uniform(0, 0.6) * std::cos(angle);
  const double ends = r / std::tan(angle);
  switch (which) {
    case 0:
      return {"flat", r, 0, 0, 0, length, flatCutter(r, length)};
    case 1:
      return {"ball", r, r, 0, 0, length, ballCutter(r, length)};
    case 2:
      return {"bull nose", r, corner, 0, 0, length, bullNoseCutter(r, corner, length)};
    case 3:
      return {"cone", r, 0, 0, angle, length + ends, coneCutter(r, angle, length + ends)};
    case 4:
      return {"cone with a flat tip", r, 0, tip, angle, length + ends, coneCutter(r, angle, length + ends, tip)};
    default:
      return {"taper", r, tip, tip, angle, length + ends, taperCutter(r, angle, tip, length + ends)};
  }
}
constexpr int kKinds = 6;

/// Where a concave function is greatest.
template <class Function>
Real whereGreatest(const Function& f, Real from, Real to) {
  for (int i = 0; i < 60; ++i) {
    const Real p = from + (to - from) * 0.49L, q = from + (to - from) * 0.51L;
    if (f(p) < f(q)) {
      from = p;
    } else {
      to = q;
    }
  }
  return 0.5L * (from + to);
}

/// The tip's height where the cutter, falling along -z on the z axis, touches a triangle; -infinity if it does not.
Real heightOver(const Kind& kind, const Corners& corners) {
  Real best = -kNever;
  // Within: the steepest way up the plane, where the cutter is as steep.
  const Point x = minus(corners[1], corners[0]), y = minus(corners[2], corners[0]);
  const Point n{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  if (n[2] != 0) {
    const Real up = -n[0] / n[2], across = -n[1] / n[2], slope = std::hypot(up, across);
    const auto rise = [&](Real out) { return slope * out - kind.height(out); };
    const Real out = slope > 0 ? whereGreatest(rise, 0, kind.radius) : 0;
    const Point at{slope > 0 ? out * up / slope : 0, slope > 0 ? out * across / slope : 0, 0};
    int left = 0, right = 0;
    for (size_t i = 0; i < 3; ++i) {
      const Point a = corners[i], b = corners[(i + 1) % 3];
      const Real side = (b[0] - a[0]) * (at[1] - a[1]) - (b[1] - a[1]) * (at[0] - a[0]);
      left += side >= 0;
      right += side <= 0;
    }
    if (left == 3 || right == 3) {
      best = corners[0][2] + up * (at[0] - corners[0][0]) + across * (at[1] - corners[0][1]) - kind.height(out);
    }
  }
  for (size_t i = 0; i < 3; ++i) {
    const Point a = corners[i], e = minus(corners[(i + 1) % 3], a);
    const Real ee = e[0] * e[0] + e[1] * e[1], ae = a[0] * e[0] + a[1] * e[1];
    const Real aa = a[0] * a[0] + a[1] * a[1] - kind.radius * kind.radius;
    if (ee == 0) {
      if (aa <= 0) best = std::max(best, std::max(a[2], a[2] + e[2]) - kind.height(std::hypot(a[0], a[1])));
      continue;
    }
    const Real root = ae * ae - ee * aa;
    if (root < 0) continue;
    const Real from = std::max<Real>((-ae - std::sqrt(root)) / ee, 0),
               to = std::min<Real>((-ae + std::sqrt(root)) / ee, 1);
    if (from > to) continue;
    const auto tip = [&](Real s) {
      return a[2] + s * e[2] - kind.height(std::min(std::hypot(a[0] + s * e[0], a[1] + s * e[1]), kind.radius));
    };
    best = std::max({best, tip(whereGreatest(tip, from, to)), tip(from), tip(to)});
  }
  return best;
}

Real supportOf(const Cutter& cutter, size_t part, const Point& n) {
  Real most = -kNever;
  for (const Ring& ring : cutter.parts[part]) {
    most =
        std::max(most, ring.height * n[2] + ring.radius * std::hypot(n[0], n[1]) + ring.corner * std::sqrt(dot(n, n)));
  }
  return most;
}

Point inTool(const Transform& pose, const Point& p) {
  const auto& m = pose.m;
  const Point d{p[0] - m[3], p[1] - m[7], p[2] - m[11]};
  return {m[0] * d[0] + m[4] * d[1] + m[8] * d[2], m[1] * d[0] + m[5] * d[1] + m[9] * d[2],
          m[2] * d[0] + m[6] * d[1] + m[10] * d[2]};
}
Point turnedIntoTool(Transform pose, const Point& v) {
  pose.m[3] = pose.m[7] = pose.m[11] = 0;
  return inTool(pose, v);
}

Result ask(const Scene& scene, const Query& query) {
  return CpuSweeper(scene, 1).run({&query, 1}).results[0];
}

std::vector<uint32_t> oneTriangle() {
  return {0, 1, 2};
}

Transform rigid(Random& random, const Vec3& at) {
  return tools::makePose(random.rotation(), tools::kFull, at);
}

std::vector<float> cornersNear(Random& random, double spread, uint64_t seed) {
  std::vector<float> out;
  for (int i = 0; i < 3; ++i) {
    for (const double x : random.inCube(spread)) out.push_back(static_cast<float>(x));
  }
  if (seed % 7 == 1) out[2] = out[5] = out[8];          // level
  if (seed % 7 == 2) out[3] = out[0], out[4] = out[1];  // an upright edge
  if (seed % 7 == 3) out[5] = out[2];                   // a level edge
  if (seed % 7 == 4) {                                  // upright
    out[6] = 2 * out[3] - out[0];
    out[7] = 2 * out[4] - out[1];
  }
  return out;
}

}  // namespace

TEST_CASE("cutters fall onto random triangles as far as closed forms say") {
  int hits = 0, clear = 0;
  std::array<int, 4> features{};
  Real worst = 0, widest = 0;
  for (uint64_t seed = 0; seed < 6000; ++seed) {
    Random random(seed);
    const Kind kind = kindOf(random, static_cast<int>(seed % kKinds));
    CAPTURE(seed, kind.name);
    const std::vector<float> corners = cornersNear(random, 2.5, seed);
    Scene scene;
    scene.addObject({scene.addMesh(corners, oneTriangle())});
    Query query{.mesh = scene.addCutter(kind.cutter), .direction = {0, 0, -1}, .distance = 40};
    for (int place = 0; place < 20; ++place) {
      const Vec3 at{random.uniform(-3, 3), random.uniform(-3, 3), 9};
      query.worldFromMesh = tools::placedAt(at);
      Corners here;
      for (size_t i = 0; i < 9; ++i) here[i / 3][i % 3] = Real(corners[i]) - (i % 3 < 2 ? at[i % 3] : 0);
      const Real expected = 9 - heightOver(kind, here);
      const Result result = ask(scene, query);
      if (result.status == Status::clear) {
        REQUIRE(expected == kNever);
        ++clear;
        continue;
      }
      REQUIRE(result.status == Status::hit);
      REQUIRE(result.lo <= expected + 1e-14);
      REQUIRE(result.hi >= expected - 1e-14);
      ++hits;
      ++features[static_cast<size_t>(result.featureB)];
      worst = std::max(worst, std::abs(result.t - expected) / kind.radius);
      widest = std::max<Real>(widest, (result.hi - result.lo) / kind.radius);
    }
  }
  CHECK(worst <= 1e-9);
  CHECK(widest <= 1e-9);
  CHECK(hits > 50000);
  CHECK(clear > 5000);
  for (size_t i = 1; i < 4; ++i) CHECK(features[i] > 1000);
}

TEST_CASE("a plane and a point prove each first contact of a cutter that moves anyhow") {
  int hits = 0, clear = 0, overlaps = 0;
  Real widest = 0;
  for (uint64_t seed = 0; seed < 5000; ++seed) {
    Random random(seed);
    const double scale = random.magnitude(-3, 3);
    const Kind kind = kindOf(random, static_cast<int>(seed % kKinds));
    CAPTURE(seed, kind.name, scale);
    Cutter cutter = kind.cutter;
    for (Ring& ring : cutter.parts[0]) ring = {scale * ring.height, scale * ring.radius, scale * ring.corner};
    if (seed % 2) cutter.parts.push_back({{scale * double(kind.length), scale * 4}, {scale * 20, scale * 6}});
    Scene scene;
    scene.addObject({scene.addMesh(cornersNear(random, 2.5 * scale, seed), oneTriangle()), random.affine({})});
    Query query{.mesh = scene.addCutter(cutter), .distance = 80 * scale};
    if (seed % 3 == 0) query.clearance = scale * random.uniform(0.1, 1);
    const Real room = query.clearance;
    // The greatest height over any plane that touches the part.
    const auto isInside = [&](const Point& p, size_t part, Real slack) {
      const Real out = std::hypot(p[0], p[1]), step = 3.14159265358979323846L / 32;
      const auto height = [&](Real turn) {
        const Point n{std::sin(turn), 0, -std::cos(turn)};
        return n[0] * out + n[2] * p[2] - supportOf(cutter, part, n) - room;
      };
      int best = 0;
      for (int i = 1; i <= 32; ++i) best = height(i * step) > height(best * step) ? i : best;
      const Real from = std::max(best - 1, 0) * step, to = std::min(best + 1, 32) * step;
      return std::max(height(best * step), height(whereGreatest(height, from, to))) <= slack;
    };
    for (int place = 0; place < 20; ++place) {
      const Vec3 away = random.direction(), aside = random.inCube(5 * scale);
      const double far = place % 5 == 0 ? 2 : 30;
      query.worldFromMesh = rigid(random, {far * scale * away[0], far * scale * away[1], far * scale * away[2]});
      for (size_t k = 0; k < 3; ++k) query.direction[k] = aside[k] - 30 * scale * away[k];
      const Result result = ask(scene, query);
      Point d{query.direction[0], query.direction[1], query.direction[2]};
      d = along({}, 1 / std::sqrt(dot(d, d)), d);
      const Point way = turnedIntoTool(query.worldFromMesh, d);
      Corners here;
      for (size_t i = 0; i < 3; ++i) {
        const auto at = transformPoint(scene.object(0).worldFromMesh, &scene.mesh(0).positions[3 * i]);
        here[i] = inTool(query.worldFromMesh, {at[0], at[1], at[2]});
      }
      const Point touched = inTool(query.worldFromMesh, {result.point[0], result.point[1], result.point[2]});
      if (result.status == Status::overlap) {
        ++overlaps;
        REQUIRE(isInside(touched, result.triA, 1e-12 * scale));
        continue;
      }
      // Points of the triangle are outside until then.
      const Real until = result.status == Status::clear ? query.distance : result.lo;
      for (int i = 0; i < 4; ++i) {
        Real u = random.uniform(0, 1), v = random.uniform(0, 1);
        if (u + v > 1) u = 1 - u, v = 1 - v;
        const Point p = along(along(here[0], u, minus(here[1], here[0])), v, minus(here[2], here[0]));
        for (size_t part = 0; part < cutter.parts.size(); ++part) {
          REQUIRE(!isInside(along(p, -until * i / 3.0L, way), part, -1e-12 * scale));
        }
      }
      if (result.status == Status::clear) {
        ++clear;
        continue;
      }
      REQUIRE(result.status == Status::hit);
      ++hits;
      const Point n = turnedIntoTool(query.worldFromMesh, {-result.normal[0], -result.normal[1], -result.normal[2]});
      const Real least = std::min({dot(n, here[0]), dot(n, here[1]), dot(n, here[2])});
      REQUIRE(least - result.lo * dot(n, way) >= supportOf(cutter, result.triA, n) + room - 1e-13 * scale);
      REQUIRE(isInside(along(touched, -Real(result.hi), way), result.triA, 1e-13 * scale));
      widest = std::max<Real>(widest, (result.hi - result.lo) / (scale * kind.radius));
    }
  }
  CHECK(widest <= 1e-9);
  CHECK(hits > 20000);
  CHECK(clear > 10000);
  CHECK(overlaps > 1000);
}

TEST_CASE("cutters fall onto a relief, also right above its vertices and edges, as far as closed forms say") {
  constexpr int kCells = 8;
  Random random(3);
  std::vector<float> corners;
  std::vector<uint32_t> faces;
  for (int i = 0; i <= kCells; ++i) {
    for (int k = 0; k <= kCells; ++k) {
      const double height = i == 4 ? 0.5 : random.uniform(-0.4, 0.4);
      for (const double x : {0.5 * i, 0.5 * k, height}) corners.push_back(static_cast<float>(x));
      if (i == kCells || k == kCells) continue;
      const auto a = static_cast<uint32_t>(i * (kCells + 1) + k), c = a + kCells + 1;
      for (const uint32_t corner : {a, c, c + 1, a, c + 1, a + 1}) faces.push_back(corner);
    }
  }
  Scene scene;
  scene.addObject({scene.addMesh(corners, faces)});
  for (int which = 0; which < kKinds; ++which) {
    const Kind kind = kindOf(random, which);
    const MeshId cutter = scene.addCutter(kind.cutter);
    for (int place = 0; place < 17 * 17; ++place) {
      const double x = 0.25 * (place % 17), y = 0.25 * (place / 17);  // NOLINT(bugprone-integer-division)
      CAPTURE(kind.name, x, y);
      Real top = -kNever;
      for (size_t f = 0; f < faces.size(); f += 3) {
        Corners here;
        for (size_t i = 0; i < 3; ++i) {
          const float* p = &corners[3 * size_t{faces[f + i]}];
          here[i] = {p[0] - x, p[1] - y, p[2]};
        }
        top = std::max(top, heightOver(kind, here));
      }
      const Result result =
          ask(scene,
              {.mesh = cutter, .worldFromMesh = tools::placedAt({x, y, 9}), .direction = {0, 0, -1}, .distance = 12});
      REQUIRE(result.status == Status::hit);
      REQUIRE(result.lo <= 9 - top + 1e-14);
      REQUIRE(result.hi >= 9 - top - 1e-14);
      REQUIRE(result.hi - result.lo <= 1e-9 * kind.radius);
    }
  }
}

TEST_CASE("cutters touch level faces, edges along the way, points and segments") {
  const std::vector<Kind> kinds = [] {
    std::vector<Kind> out;
    Random random(5);
    for (int i = 0; i < kKinds; ++i) out.push_back(kindOf(random, i));
    return out;
  }();
  const std::vector<std::vector<float>> shapes{
      {-9, -9, 1, 9, -9, 1, 0, 9, 1},               // level, below all of the cutter
      {0.1f, 0, 1, 9, 0, 1, 9, 9, 1},               // level, below a part of it
      {0.1f, 0.1f, -3, 0.1f, 0.1f, 1, 0.1f, 2, 0},  // along the way
      {0.1f, 0, 1, 0.1f, 0, 1, 0.1f, 0, 1},         // a point
      {-0.1f, 0, 1, 0.2f, 0, 2, 0.2f, 0, 2},        // a segment
      {0.1f, 0, -1, 0.1f, 0, 2, 0.1f, 0, 1},        // one along the way
  };
  for (const Kind& kind : kinds) {
    for (const std::vector<float>& shape : shapes) {
      for (const double far : {0.0, 1e5}) {
        CAPTURE(kind.name, shape, far);
        Scene scene;
        scene.addObject({scene.addMesh(shape, oneTriangle()), tools::placedAt({far, -far, 2 * far})});
        const Result result = ask(scene, {.mesh = scene.addCutter(kind.cutter),
                                          .worldFromMesh = tools::placedAt({far, -far, 9 + 2 * far}),
                                          .direction = {0, 0, -1},
                                          .distance = 40});
        Corners here;
        for (size_t i = 0; i < 9; ++i) here[i / 3][i % 3] = shape[i];
        const Real expected = 9 - heightOver(kind, here);
        REQUIRE(result.status == Status::hit);
        CHECK(result.lo <= expected + 1e-14 * (1 + far));
        CHECK(result.hi >= expected - 1e-14 * (1 + far));
        CHECK(result.hi - result.lo <= 1e-11);
      }
    }
  }
}

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
  CHECK_THROWS_WITH(ballCutter(1, 0.5), test::StartsWith("ballCutter: length: expected at least the radius"));
  CHECK_THROWS_WITH(bullNoseCutter(1, 2, 9), test::StartsWith("bullNoseCutter: corner: "));
  CHECK_THROWS_WITH(coneCutter(1, 0.1, 9, 1), test::StartsWith("coneCutter: tipRadius: "));
  CHECK_THROWS_WITH(coneCutter(1, 0.1, 9), test::Contains("where the cone ends"));
  CHECK_THROWS_WITH(taperCutter(1, 0.5, 0.95, 9), test::Contains("so that the cone is wider"));
  CHECK_THROWS_WITH(plate.scene.addCutter({}), test::Contains("expected one part or more"));
  CHECK_THROWS_WITH(plate.scene.addCutter({{{{0, 1}}}}), test::Contains("part 0: expected rings that span a solid"));
  CHECK_THROWS_WITH(plate.scene.addCutter({{{{0, -1}, {1, 1}}}}),
                    test::Contains("part 0: radius: expected 0 to 2^100"));
}
