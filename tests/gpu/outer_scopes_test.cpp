// What an outer scope holds of a triangle, against coverage decided exactly: no pixel that the triangle touches is
// missing, and its true depths over that pixel lie between the bounds.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "exact/dyadic.h"
#include "gpu/device.h"
#include "support/test_device.h"
#include "sweep/bounded_recorder.h"
#include "workloads/random.h"

namespace {

using namespace radar;
using exact::Dyadic;
using tools::Random;

// Coordinates across the window, exactly: the sum of up to three doubles.
struct Coordinate {
  double terms[3];
  double rounded() const { return (terms[0] - terms[1]) - terms[2]; }
  Dyadic whole() const { return Dyadic(terms[0]) - Dyadic(terms[1]) - Dyadic(terms[2]); }
};
struct Point {
  Coordinate x, y;
};

// Greater than what doubles lose in a determinant of such coordinates, all below 4 in magnitude but for triangles
// larger than that, whose own magnitude counts.
double orientationError(double magnitude) {
  return 1e-14 * (magnitude * magnitude + 16);
}

// Sign of (q - p) x (r - p), exactly.
int orientation(const Point& p, const Point& q, const Point& r, double magnitude) {
  const double px = p.x.rounded(), py = p.y.rounded();
  const double d = (q.x.rounded() - px) * (r.y.rounded() - py) - (q.y.rounded() - py) * (r.x.rounded() - px);
  if (std::abs(d) > orientationError(magnitude)) return d > 0 ? 1 : -1;
  const Dyadic x = p.x.whole(), y = p.y.whole();
  return ((q.x.whole() - x) * (r.y.whole() - y) - (q.y.whole() - y) * (r.x.whole() - x)).sign();
}

int compare(const Coordinate& p, const Coordinate& q) {
  const double d = p.rounded() - q.rounded();
  if (std::abs(d) > 1e-14 * (4 + std::abs(p.rounded()) + std::abs(q.rounded()))) return d > 0 ? 1 : -1;
  return (p.whole() - q.whole()).sign();
}

struct Square {
  Coordinate loX, hiX, loY, hiY;
};

// Whether the closed triangle and the closed square have a point in common: no edge of either separates them.
bool touches(const Point (&t)[3], const Square& square, double magnitude) {
  const auto all = [&](auto&& beyond) { return beyond(t[0]) && beyond(t[1]) && beyond(t[2]); };
  if (all([&](const Point& p) { return compare(p.x, square.loX) < 0; }) ||
      all([&](const Point& p) { return compare(p.x, square.hiX) > 0; }) ||
      all([&](const Point& p) { return compare(p.y, square.loY) < 0; }) ||
      all([&](const Point& p) { return compare(p.y, square.hiY) > 0; })) {
    return false;
  }
  const Point corners[4] = {
      {square.loX, square.loY}, {square.hiX, square.loY}, {square.loX, square.hiY}, {square.hiX, square.hiY}};
  for (int i = 0; i < 3; ++i) {
    const Point &p = t[i], &q = t[(i + 1) % 3];
    const int inner = orientation(p, q, t[(i + 2) % 3], magnitude);
    int left = 0, right = 0;
    for (const Point& corner : corners) {
      const int side = orientation(p, q, corner, magnitude);
      left += side > 0;
      right += side < 0;
    }
    if ((left == 4 && inner <= 0) || (right == 4 && inner >= 0)) return false;
  }
  return true;
}

// Least and greatest depth of the triangle over the square, by clipping; doubles lose far less than float's margins.
std::array<double, 2> depthsOver(const std::array<double, 3> (&t)[3], const double (&low)[2], const double (&high)[2]) {
  std::vector<std::array<double, 3>> polygon(t, t + 3), next;
  for (int side = 0; side < 4; ++side) {
    const int axis = side / 2;
    const double sign = side % 2 ? -1 : 1, limit = side % 2 ? -high[axis] : low[axis];
    next.clear();
    for (size_t i = 0; i < polygon.size(); ++i) {
      const auto &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const double dp = sign * p[axis] - limit, dq = sign * q[axis] - limit;
      if (dp >= 0) next.push_back(p);
      if ((dp < 0) == (dq < 0)) continue;
      const double s = dp / (dp - dq);
      next.push_back({p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1]), p[2] + s * (q[2] - p[2])});
    }
    polygon.swap(next);
  }
  std::array<double, 2> range{1e300, -1e300};
  for (const auto& p : polygon) range = {std::min(range[0], p[2]), std::max(range[1], p[2])};
  return range;
}

constexpr double kSpacing = 64;  // of the triangles, along the motion

enum class Kind { random, large, tiny, sliver, line, point, edgeOn, aligned, count };

// Corners about the window [-1, 1]^2, depth within 16.
std::array<float, 9> corners(Kind kind, Random& random) {
  std::array<float, 9> t{};
  const auto spot = [&](int i, double reach) {
    for (int k = 0; k < 3; ++k) t[3 * i + k] = static_cast<float>(random.uniform(-reach, reach) * (k == 2 ? 8 : 1));
  };
  const auto near = [&](int i, int of, double reach) {
    for (int k = 0; k < 3; ++k) t[3 * i + k] = t[3 * of + k] + static_cast<float>(random.uniform(-reach, reach));
  };
  for (int i = 0; i < 3; ++i) spot(i, 1.2);
  const double small = std::pow(10, random.uniform(-9, -1));
  if (kind == Kind::large) {
    const double reach = std::pow(10, random.uniform(0, 4));
    for (float& x : t) x *= static_cast<float>(reach);
    for (int i = 0; i < 3; ++i) t[3 * i + 2] = static_cast<float>(random.uniform(-8, 8));
  } else if (kind == Kind::tiny) {
    near(1, 0, small);
    near(2, 0, small);
  } else if (kind == Kind::sliver) {
    const double s = random.uniform(-0.5, 1.5);
    for (int k = 0; k < 3; ++k)
      t[6 + k] = static_cast<float>(t[k] + s * (t[3 + k] - t[k]) + random.uniform(-small, small));
  } else if (kind == Kind::line) {
    for (int k = 0; k < 3; ++k) t[6 + k] = random.below(2) ? t[k] : (t[k] + t[3 + k]) / 2;
  } else if (kind == Kind::point) {
    for (int k = 0; k < 3; ++k) t[3 + k] = t[6 + k] = t[k];
  } else if (kind == Kind::edgeOn) {
    for (int k = 0; k < 2; ++k) t[6 + k] = t[3 + k];
  } else if (kind == Kind::aligned) {
    for (int k = 0; k < 2; ++k) t[3 + k] = t[k + 3 * static_cast<int>(random.below(2))];
    t[6 + random.below(2)] = t[random.below(2)];
  }
  return t;
}

struct Tally {
  uint64_t triangles = 0, touched = 0, extra = 0, missed = 0, wrongDepth = 0, unlike = 0;
};

void check(const BoundedPlan& plan, const StoredOuterScopes& scopes, const SensorWindow& window, const Pose& pose,
           const std::array<float, 9>& t, Tally& tally) {
  ++tally.triangles;
  Point p[3];
  std::array<double, 3> inPixels[3];
  double magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    const std::array<double, 3> world = place(pose, &t[3 * i]);
    p[i] = {{{world[0], window.origin[0], window.box.lo[0]}}, {{world[1], window.origin[1], window.box.lo[1]}}};
    inPixels[i] = {p[i].x.rounded() / plan.pixel, p[i].y.rounded() / plan.pixel,
                   (world[2] - window.origin[2]) / plan.pixel};
    magnitude = std::max({magnitude, std::abs(p[i].x.rounded()), std::abs(p[i].y.rounded())});
  }
  const auto line = [&](uint32_t i) { return Coordinate{{i * plan.pixel, 0, 0}}; };
  for (uint32_t y = 0; y < plan.view.height; ++y) {
    for (uint32_t x = 0; x < plan.view.width; ++x) {
      const size_t at = size_t{y} * plan.view.width + x;
      const bool covered = !std::isnan(scopes.sceneFarthest[at]);
      const bool truly = touches(p, {line(x), line(x + 1), line(y), line(y + 1)}, magnitude);
      tally.touched += truly;
      tally.extra += covered && !truly;
      tally.missed += truly && !covered;
      if (!truly || !covered) continue;
      const std::array<double, 2> range = depthsOver(inPixels, {double(x), double(y)}, {x + 1.0, y + 1.0});
      if (range[0] > range[1]) continue;  // touched, within what doubles lose
      tally.wrongDepth += !(scopes.sceneNearest[at] <= range[0] && scopes.sceneFarthest[at] >= range[1]);
    }
  }
}

bool sameBits(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

// `count` triangles, each before a square sensor of its own, far enough apart not to see each other; drawn in one
// submission by triangle, and in another by pixel.
void checkBatch(uint32_t count, uint32_t pixels, Random& random, Tally& tally) {
  Scene scene;
  const float h = 1;
  const std::vector<float> square{-h, -h, 0, h, -h, 0, h, h, 0, -h, h, 0};
  const MeshId sensor = scene.addMesh(square, std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  std::vector<std::array<float, 9>> triangles;
  std::vector<Pose> poses;
  for (uint32_t i = 0; i < count; ++i) {
    const auto kind = static_cast<Kind>(random.below(static_cast<uint32_t>(Kind::count)));
    triangles.push_back(corners(kind, random));
    Pose pose;
    if (random.below(2) != 0) {  // turned, sheared, mirrored
      const double angle = random.uniform(0, 2 * std::numbers::pi), scale = random.uniform(0.3, 1.5);
      pose.m = {scale * std::cos(angle),
                -std::sin(angle),
                0.1,
                0.2,
                std::sin(angle),
                scale * std::cos(angle),
                0,
                -0.1,
                0.2,
                0.1,
                -1,
                0};
      if (kind == Kind::large) pose.m[8] = pose.m[9] = 0;  // not in sight of the other sensors
    }
    pose.m[11] += kSpacing * i + 20;
    poses.push_back(pose);
    scene.addObject({scene.addMesh(triangles.back(), std::vector<uint32_t>{0, 1, 2}), pose, ~0u});
  }
  Hierarchy hierarchy;
  hierarchy.update(scene.impl());
  ResidentScene resident(test::device().impl());
  BoundedRecorder recorder(test::device().impl(), resident, false);
  std::vector<BoundedPlan> plans, byPixel;
  std::vector<const BoundedPlan*> drawn, drawnByPixel;
  std::vector<SensorWindow> windows;
  std::vector<uint32_t> numbers;
  for (uint32_t i = 0; i < count; ++i) {
    Query query{.mesh = sensor, .direction = {0, 0, 1}, .distance = 40};
    query.worldFromMesh.m[11] = kSpacing * i;
    BoundedPlan plan = planBounded(query, scene.impl(), hierarchy, pixels, false);
    if (plan.sceneBands.empty()) continue;
    REQUIRE(plan.measurable);
    REQUIRE(plan.sensorStrip + plan.sceneStrip == 0);
    plans.push_back(std::move(plan));
    byPixel.push_back(planBounded(query, scene.impl(), hierarchy, pixels, true));
    REQUIRE(std::min(byPixel.back().sensorStrip, byPixel.back().sceneStrip) > 0);
    windows.push_back(lookAlong(query, scene.impl().meshes[sensor]));
    numbers.push_back(i);
  }
  for (const BoundedPlan& plan : plans) drawn.push_back(&plan);
  for (const BoundedPlan& plan : byPixel) drawnByPixel.push_back(&plan);
  std::vector<StoredOuterScopes> scopes, scopesByPixel;
  std::vector<StageTime> stages;
  recorder.submit(drawn, scene.impl(), stages, &scopes);
  recorder.submit(drawnByPixel, scene.impl(), stages, &scopesByPixel);
  for (size_t i = 0; i < plans.size(); ++i) {
    check(plans[i], scopes[i], windows[i], poses[numbers[i]], triangles[numbers[i]], tally);
    const StoredOuterScopes &a = scopes[i], &b = scopesByPixel[i];
    tally.unlike += !(sameBits(a.sensorNearest, b.sensorNearest) && sameBits(a.sceneNearest, b.sceneNearest) &&
                      sameBits(a.sceneFarthest, b.sceneFarthest) && sameBits(a.sensorFarthest, b.sensorFarthest));
  }
}

void checkTriangles(uint32_t batches, uint32_t pixels, uint64_t seed) {
  Random random(seed);
  Tally tally;
  for (uint32_t i = 0; i < batches; ++i) checkBatch(1024, pixels, random, tally);
  WARN(tally.triangles << " triangles, " << tally.touched << " pixels touched, extra pixels "
                       << 100.0 * tally.extra / tally.touched << "%");
  CHECK(tally.triangles > 500 * batches);
  CHECK(tally.touched > 5000 * batches);
  CHECK(tally.missed == 0);
  CHECK(tally.wrongDepth == 0);
  CHECK(tally.unlike == 0);  // the two ways
  CHECK(tally.extra < 0.02 * tally.touched);
}

}  // namespace

TEST_CASE("an outer scope misses no pixel that a triangle touches, and bounds its depth there") {
  checkTriangles(4, 17, 1);  // rows that are no whole groups of pixels
}

TEST_CASE("triangles that each fill the window are drawn to its last pixel, by triangle and by pixel") {
  // Lavapipe ends loops silently after 65,535 iterations of an invocation.
  const auto [resolution, triangles] =
      GENERATE(table<uint32_t, uint32_t>({{64, 64}, {64, 3000}, {256, 64}, {1024, 64}}));
  const bool byPixel = GENERATE(false, true);
  CAPTURE(resolution, triangles, byPixel);
  constexpr double kPlacement = 1e-4;  // of a mesh that reaches as far as 66
  Scene scene;
  const std::vector<float> square{-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0};
  const MeshId sensor = scene.addMesh(square, std::vector<uint32_t>{0, 1, 2, 0, 2, 3});
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  for (uint32_t i = 0; i < triangles; ++i) {
    const float z = 3 + 63 * static_cast<float>(i) / static_cast<float>(triangles - 1);
    positions.insert(positions.end(), {-9, -9, z, 9, -9, z, 0, 18, z});
    for (uint32_t k = 0; k < 3; ++k) indices.push_back(3 * i + k);
  }
  scene.addObject({scene.addMesh(positions, indices), {}, ~0u});
  Hierarchy hierarchy;
  hierarchy.update(scene.impl());
  ResidentScene resident(test::device().impl());
  BoundedRecorder recorder(test::device().impl(), resident, false);
  const BoundedPlan plan = planBounded({.mesh = sensor, .direction = {0, 0, 1}, .distance = 100}, scene.impl(),
                                       hierarchy, resolution, byPixel);
  REQUIRE((plan.sceneStrip > 0) == byPixel);
  const BoundedPlan* plans[] = {&plan};
  std::vector<StoredOuterScopes> scopes;
  std::vector<StageTime> stages;
  const float lo = recorder.submit(plans, scene.impl(), stages, &scopes).answers[0].lo;
  CHECK(lo * plan.pixel == Approx(3).margin(kPlacement));
  const auto everywhere = [&](const std::vector<float>& scope, double z) {
    return std::all_of(scope.begin(), scope.end(),
                       [&](float depth) { return depth * plan.pixel == Approx(z).margin(kPlacement); });
  };
  CHECK(everywhere(scopes[0].sceneNearest, 3));
  CHECK(everywhere(scopes[0].sceneFarthest, 66));
  // The sensor leaves the window's margin empty, which is much less than a pixel.
  CHECK(everywhere(scopes[0].sensorFarthest, 0));
}

TEST_CASE("an outer scope misses no pixel of nearly a million triangles", "[.][million]") {
  checkTriangles(1100, 16, 2);
}
