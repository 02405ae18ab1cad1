// Cutters that fall, against closed forms in long doubles.
#include <algorithm>
#include <cmath>

#include "cutter_kinds.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::test;
using tools::Random;
using tools::Vec3;

namespace {

using Corners = std::array<Point, 3>;

/// The tip's height where the cutter, falling along -z on the z axis, touches a triangle; -infinity if it does not.
Real heightOver(const CutterKind& kind, const Corners& corners) {
  Real best = -kNever;
  // Within: the steepest way up the plane, where the cutter is as steep.
  const Point x = corners[1] - corners[0], y = corners[2] - corners[0];
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
    const Point a = corners[i], e = corners[(i + 1) % 3] - a;
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

}  // namespace

TEST_CASE("cutters fall onto random triangles as far as closed forms say") {
  int hits = 0, clear = 0;
  std::array<int, 4> features{};
  Real worst = 0, widest = 0;
  for (uint64_t seed = 0; seed < 6000; ++seed) {
    Random random(seed);
    const CutterKind kind = cutterOf(static_cast<int>(seed % kCutterKinds), random);
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
      const Result result = answer(scene, query);
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
  for (int which = 0; which < kCutterKinds; ++which) {
    const CutterKind kind = cutterOf(which, random);
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
      const Result result = answer(
          scene,
          {.mesh = cutter, .worldFromMesh = tools::placedAt({x, y, 9}), .direction = {0, 0, -1}, .distance = 12});
      REQUIRE(result.status == Status::hit);
      REQUIRE(result.lo <= 9 - top + 1e-14);
      REQUIRE(result.hi >= 9 - top - 1e-14);
      REQUIRE(result.hi - result.lo <= 1e-9 * kind.radius);
    }
  }
}

TEST_CASE("cutters touch level faces, edges along the way, points and segments") {
  const std::vector<CutterKind> kinds = [] {
    std::vector<CutterKind> out;
    Random random(5);
    for (int i = 0; i < kCutterKinds; ++i) out.push_back(cutterOf(i, random));
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
  for (const CutterKind& kind : kinds) {
    for (const std::vector<float>& shape : shapes) {
      for (const double far : {0.0, 1e5}) {
        CAPTURE(kind.name, shape, far);
        Scene scene;
        scene.addObject({scene.addMesh(shape, oneTriangle()), tools::placedAt({far, -far, 2 * far})});
        const Result result = answer(scene, {.mesh = scene.addCutter(kind.cutter),
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
