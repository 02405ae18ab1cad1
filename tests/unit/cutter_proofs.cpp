// Proofs of each answer about a cutter, in long doubles.
#include <algorithm>
#include <cmath>

#include "cutter_kinds.h"
#include "support/catch.h"

using namespace radar;
using namespace radar::test;
using tools::Random;
using tools::Vec3;

namespace {

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

Transform rigid(Random& random, const Vec3& at) {
  return tools::makePose(random.rotation(), tools::kFull, at);
}

}  // namespace

TEST_CASE("a plane and a point prove each first contact of a cutter that moves anyhow") {
  int hits = 0, clear = 0, overlaps = 0;
  Real widest = 0;
  for (uint64_t seed = 0; seed < 1000; ++seed) {
    Random random(seed);
    const double scale = random.magnitude(-3, 3);
    const CutterKind kind = cutterOf(static_cast<int>(seed % kCutterKinds), random);
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
      const Result result = answer(scene, query);
      Point d{query.direction[0], query.direction[1], query.direction[2]};
      d = 1 / std::sqrt(dot(d, d)) * d;
      const Point way = turnedIntoTool(query.worldFromMesh, d);
      std::array<Point, 3> here;
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
        const Point p = here[0] + u * (here[1] - here[0]) + v * (here[2] - here[0]);
        for (size_t part = 0; part < cutter.parts.size(); ++part) {
          REQUIRE(!isInside(p - (until * i / 3) * way, part, -1e-12 * scale));
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
      REQUIRE(isInside(touched - result.hi * way, result.triA, 1e-13 * scale));
      widest = std::max<Real>(widest, (result.hi - result.lo) / (scale * kind.radius));
    }
  }
  CHECK(widest <= 1e-9);
  CHECK(hits > 4000);
  CHECK(clear > 2000);
  CHECK(overlaps > 200);
}
