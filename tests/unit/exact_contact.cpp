// Compares the contact interval of two triangles with separating axes in exact rationals.
#include <algorithm>
#include <limits>

#include "distances.h"
#include "exact/common_point.h"
#include "exact/contact.h"
#include "exact/event.h"
#include "exact_oracle.h"
#include "soups.h"
#include "support/catch.h"

using namespace radar::exact;
using oracle::Fraction;
using oracle::Rational;
using radar::Vector;
using soups::latticeTriangle;
using soups::Random;

namespace {

Rational rational(const Fraction& f) {
  return Rational(f.num, f.den);
}

/// Whether `rounded` is the double nearest to some number within 2^-60 of `exact`.
bool isNearest(double rounded, const Rational& exact) {
  if (!std::isfinite(rounded)) return abs(exact) > Rational(std::numeric_limits<double>::max());
  const auto [below, above] = oracle::roundedTo(rounded);
  const Rational slack = abs(exact) * Rational(0x1p-60);
  return below - slack <= exact && exact <= above + slack;
}

using RationalVector = std::array<Rational, 3>;

RationalVector minus(const RationalVector& p, const RationalVector& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
RationalVector cross(const RationalVector& p, const RationalVector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
Rational dot(const RationalVector& p, const RationalVector& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

using RationalTriangle = std::array<RationalVector, 3>;

RationalTriangle moved(const Triangle& t, const Vector& direction, const Rational& s) {
  RationalTriangle result;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) result[i][k] = Rational(t[i][k]) + s * Rational(direction[k]);
  }
  return result;
}

RationalVector normalOf(const RationalTriangle& t) {
  return cross(minus(t[1], t[0]), minus(t[2], t[0]));
}

/// The least feature of `t` that contains all of it which is in `other`: `t` is clipped by the other's plane and edges,
/// in barycentric coordinates.
radar::Feature featureIn(const RationalTriangle& t, const RationalTriangle& other) {
  std::vector<RationalVector> polygon{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const RationalVector n = normalOf(other);
  std::vector<std::pair<RationalVector, RationalVector>> sides{{n, other[0]}, {minus({0, 0, 0}, n), other[0]}};
  for (size_t i = 0; i < 3; ++i) sides.emplace_back(cross(n, minus(other[(i + 1) % 3], other[i])), other[i]);
  for (const auto& [inward, origin] : sides) {
    const RationalVector heights{dot(inward, minus(t[0], origin)), dot(inward, minus(t[1], origin)),
                                 dot(inward, minus(t[2], origin))};
    std::vector<RationalVector> clipped;
    for (size_t i = 0; i < polygon.size(); ++i) {
      const RationalVector &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
      const Rational above = dot(heights, p), below = dot(heights, q);
      if (above >= 0) clipped.push_back(p);
      if (above.sign() * below.sign() >= 0) continue;
      const Rational share = above / (above - below);
      RationalVector crossing;
      for (size_t k = 0; k < 3; ++k) crossing[k] = p[k] + share * (q[k] - p[k]);
      clipped.push_back(crossing);
    }
    polygon = std::move(clipped);
  }
  uint32_t corners = 0;
  for (size_t k = 0; k < 3; ++k) {
    corners += std::any_of(polygon.begin(), polygon.end(), [&](const RationalVector& p) { return p[k] > 0; });
  }
  return static_cast<radar::Feature>(corners);
}

void checkFeatures(const Features& features, const Triangle& a, const Triangle& b, const Vector& direction,
                   const Rational& s) {
  const RationalTriangle there = moved(a, direction, s), here = moved(b, direction, 0);
  const RationalVector none{0, 0, 0};
  if (normalOf(there) == none || normalOf(here) == none) return;
  REQUIRE(features.a == featureIn(there, here));
  REQUIRE(features.b == featureIn(here, there));
}

/// `features`: also checks the features that touch, which takes long.
void check(const Triangle& a, const Triangle& b, const Vector& direction, bool features) {
  const auto ours = contact(a, b, direction);
  const auto truth = oracle::contact(a, b, direction);
  REQUIRE(ours.has_value() == truth.has_value());
  if (!ours) return;
  for (const auto& [event, fraction] : {std::pair{ours->first, truth->first}, std::pair{ours->last, truth->last}}) {
    const Rational s = rational(fraction);
    REQUIRE(isNearest(parameter(event), s));
    REQUIRE(sign(event) == s.sign());
    if (std::isfinite(event.error)) REQUIRE(abs(Rational(event.s) - s) <= Rational(event.error));
    const double t = std::abs(event.s) * length(direction);
    for (double distance : {0.0, t, std::nextafter(t, 0), std::nextafter(t, INFINITY), 2 * t}) {
      if (!std::isfinite(distance)) continue;
      const int expected = s.sign() < 0 ? -1 : oracle::compareToDistance(fraction, direction, distance);
      REQUIRE(compareToDistance(event, distance) == expected);
    }
  }
  REQUIRE(compare(ours->first, ours->last) == oracle::compare(truth->first, truth->last));
  const auto begun = contact(a, b, direction, Ahead::beginning);
  REQUIRE(begun.has_value());
  const bool isWhole = rational(truth->first).sign() <= 0;
  const auto isSame = [](const Event& p, const Event& q) { return !precedes(p, q) && !precedes(q, p); };
  REQUIRE(isSame(begun->first, ours->first));
  REQUIRE(isSame(begun->last, isWhole ? ours->last : ours->first));
  REQUIRE(begun->isSharp == ours->isSharp);
  // Swapping the triangles and reversing the direction changes no bit.
  const auto swapped = contact(b, a, {-direction[0], -direction[1], -direction[2]});
  REQUIRE(swapped.has_value());
  REQUIRE(parameter(swapped->first) == parameter(ours->first));
  REQUIRE(parameter(swapped->last) == parameter(ours->last));
  if (!features) return;
  const Rational first = rational(truth->first), last = rational(truth->last);
  checkFeatures(ours->atFirst.features(), a, b, direction, first);
  checkFeatures(ours->atLast.features(), a, b, direction, last);
  if (first < last) checkFeatures(ours->between.features(), a, b, direction, (first + 2 * last) / 3);
}

/// Moves one coordinate by one ulp.
void nudge(Random& random, Triangle& t) {
  double& c = t[static_cast<size_t>(random.integer(0, 2))][static_cast<size_t>(random.integer(0, 2))];
  c = std::nextafter(c, random.chance(0.5) ? INFINITY : -INFINITY);
}

void scale(Triangle& t, double by) {
  for (Vector& c : t) {
    for (double& v : c) v *= by;
  }
}

}  // namespace

TEST_CASE("the contact interval is exact on integer lattices") {
  Random random(1);
  for (int i = 0; i < 20000; ++i) {
    INFO("case " << i);
    const int side = random.integer(1, 4);
    check(latticeTriangle(random, side), latticeTriangle(random, side), random.latticeVector(random.integer(1, 3)),
          i % 8 == 0);
  }
}

TEST_CASE("the contact interval is exact one ulp beside integer lattices") {
  Random random(2);
  for (int i = 0; i < 8000; ++i) {
    INFO("case " << i);
    Triangle a = latticeTriangle(random, 3), b = latticeTriangle(random, 3);
    for (int n = random.integer(1, 3); n-- > 0;) nudge(random, random.chance(0.5) ? a : b);
    Vector d = random.latticeVector(random.integer(1, 3));
    if (random.chance(0.3)) d[0] = std::nextafter(d[0], 9);
    check(a, b, d, i % 16 == 0);
  }
}

TEST_CASE("the contact interval is exact for triangles in general position, needles and slivers") {
  Random random(3);
  for (int i = 0; i < 6000; ++i) {
    INFO("case " << i);
    const radar::tools::MeshData mesh = soups::soup(random, 2, random.uniform(0.3, 2), 0.4);
    const radar::Transform pose = random.pose(1, {0, 0, 0});
    const radar::MeshView view{mesh.positions, mesh.indices};
    check(oracle::corners(view, radar::Transform{}, 0), oracle::corners(view, pose, 1), random.inBall(), i % 20 == 0);
  }
}

TEST_CASE("the contact interval is exact for all finite doubles") {
  Random random(4);
  for (double size : {1e-300, 1e-150, 1e-60, 1e-10, 1e10, 1e60, 1e150, 1e290}) {
    for (double speed : {1e-300, 1e-60, 1.0, 1e60, 1e300}) {
      for (int i = 0; i < 60; ++i) {
        INFO("size " << size << " speed " << speed << " case " << i);
        Triangle a = latticeTriangle(random, 3), b = latticeTriangle(random, 3);
        for (Triangle* t : {&a, &b}) {
          if (random.chance(0.5)) nudge(random, *t);
          scale(*t, size);
        }
        Vector d = random.latticeVector(random.integer(1, 3));
        for (double& c : d) c *= speed;
        check(a, b, d, false);
      }
    }
  }
  // Sizes that differ by factors of up to 2^2000.
  for (int i = 0; i < 300; ++i) {
    INFO("mixed, case " << i);
    Triangle a = latticeTriangle(random, 3), b = latticeTriangle(random, 3);
    scale(a, std::ldexp(1, random.integer(-1000, 1000)));
    scale(b, std::ldexp(1, random.integer(-1000, 1000)));
    check(a, b, random.latticeVector(random.integer(1, 3)), false);
  }
}

TEST_CASE("events at the same parameter compare equal, whatever their features") {
  // A vertex falls on the corner where four triangles meet, over faces, edges and a vertex at once.
  const Triangle a{Vector{0, 0, 5}, Vector{1, 0, 6}, Vector{0, 1, 6}};
  std::vector<Event> events;
  for (const Triangle& b : {Triangle{Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{0, 1, 0}},
                            Triangle{Vector{0, 0, 0}, Vector{0, 1, 0}, Vector{-1, 0, -1}},
                            Triangle{Vector{-1, 0, 0}, Vector{0, -1, 0}, Vector{0, 0, 0}},
                            Triangle{Vector{1, 0, 0}, Vector{0, 0, 0}, Vector{0, -1, 0}}}) {
    const auto interval = contact(a, b, {0, 0, -1});
    REQUIRE(interval);
    events.push_back(interval->first);
  }
  for (const Event& p : events) {
    REQUIRE(parameter(p) == 5);
    for (const Event& q : events) REQUIRE(compare(p, q) == 0);
  }
}

TEST_CASE("events across one axis compare as their fractions do, in doubles that no integers hold together") {
  Random random(6);
  const auto level = [&] {
    return random.chance(0.7) ? 0.1 * random.integer(0, 2) : std::ldexp(0.3, random.integer(-70, 0));
  };
  size_t ties = 0, others = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector d = random.inBall();
    std::vector<Event> events;
    for (int k = 0; k < 3; ++k) {
      const int axis = random.chance(0.2) ? 1 : 2;
      const auto flat = [&](double at) {
        Triangle t{random.inBall(), random.inBall(), random.inBall()};
        for (Vector& corner : t) corner[axis] = at;
        return t;
      };
      const Triangle a = flat(level()), b = flat(level());
      events.push_back(random.chance(0.5) ? vertexFace(d, a[0], b) : edgeEdge(d, a[0], a[1], b[0], b[1]));
    }
    for (const Event& p : events) {
      for (const Event& q : events) {
        const int order = compare(ratio(p), ratio(q));
        REQUIRE(compare(p, q) == order);
        if (&p != &q) ++(order == 0 ? ties : others);
      }
    }
  }
  CHECK(ties > 100);
  CHECK(others > 1000);
}

TEST_CASE("parameters that round to the same double compare as different") {
  const auto fall = [](double floor) {
    const Triangle ground{Vector{-9, -9, floor}, Vector{9, -9, floor}, Vector{0, 9, floor}};
    const Triangle a{Vector{0, 0, 1}, Vector{1, 0, 9}, Vector{0, 1, 9}};
    return contact(a, ground, {0, 0, -3})->first;
  };
  const Event third = fall(0);
  for (double less : {0x1p-54, 0x1p-100, 0x1p-200, 0x1p-1074}) {
    const Event near = fall(less);
    REQUIRE(parameter(near) == parameter(third));
    REQUIRE(compare(near, third) == -1);
    REQUIRE(compare(third, near) == 1);
    REQUIRE(compareToDistance(third, 1) == 0);
    REQUIRE(compareToDistance(near, 1) == -1);
    REQUIRE(compareToDistance(fall(-less), 1) == 1);
  }
}

TEST_CASE("the length of a direction is rounded to the nearest double") {
  Random random(5);
  const auto check = [](const Vector& d) {
    const double r = length(d);
    Rational square = 0;
    for (double c : d) square += Rational(c) * Rational(c);
    const auto [below, above] = oracle::roundedTo(r);
    REQUIRE(below * below <= square);
    REQUIRE(square <= above * above);
  };
  for (int i = 0; i < 5000; ++i) check({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)});
  for (double size : {1e-320, 1e-200, 1e-60, 1e60, 1e200, 1e307}) check({size, -2 * size, 1.5 * size});
  REQUIRE(length({3, 0, -4}) == 5);
  REQUIRE(length({0, 0, -0.1}) == 0.1);
  constexpr double kMost = std::numeric_limits<double>::max();
  REQUIRE(length({kMost, 1e-300, 0}) == kMost);
  REQUIRE(length({0x1p997, kMost, 0}) == kMost);
  REQUIRE(std::isinf(length({0x1p998, kMost, 0})));
}

TEST_CASE("contact point and normal are those of the touching features") {
  const Triangle floor{Vector{-9, -9, 0}, Vector{9, -9, 0}, Vector{0, 9, 0}};
  const Triangle tip{Vector{0, 0, 2}, Vector{1, 0, 3}, Vector{0, 1, 3}};
  const auto down = contact(tip, floor, {0, 0, -1})->first;
  REQUIRE(down.kind == Kind::vertexFace);
  REQUIRE(point(down, parameter(down)) == Vector{0, 0, 0});
  REQUIRE(normal(down) == Vector{0, 0, 1});
  const auto up = contact(floor, tip, {0, 0, 1})->first;
  REQUIRE(up.kind == Kind::faceVertex);
  REQUIRE(point(up, parameter(up)) == Vector{0, 0, 2});
  REQUIRE(normal(up) == Vector{0, 0, -1});
  const auto edges = contact({Vector{-1, 0, 4}, Vector{1, 0, 4}, Vector{0, 0, 5}},
                             {Vector{0.5, -1, 0}, Vector{0.5, 1, 0}, Vector{0.5, 0, -1}}, {0, 0, -2})
                         ->first;
  REQUIRE(edges.kind == Kind::edgeEdge);
  REQUIRE(parameter(edges) == 2);
  REQUIRE(point(edges, 2) == Vector{0.5, 0, 0});
  REQUIRE(normal(edges) == Vector{0, 0, 1});
  const auto flat = contact({Vector{0, 0, 0}, Vector{1, 0, 0}, Vector{0, 0, 1}},
                            {Vector{5, 0, 0}, Vector{6, 0, 0}, Vector{5, 0, 1}}, {1, 0, 0})
                        ->first;
  REQUIRE(parameter(flat) == 4);
  REQUIRE(std::isnan(normal(flat)[0]));
}

TEST_CASE("a common point is on both triangles, also where only their corners or borders cross, by rounding errors") {
  Random random(77);
  size_t crossing = 0;
  for (int round = 0; round < 40'000; ++round) {
    const auto ball = [&] { return random.inBall(); };
    const Triangle face{ball(), ball(), ball()};
    Triangle other{ball(), ball(), ball()};
    // Corner 0 of the other is near corner 0 of the face, or near its first side.
    const double depth = std::pow(10, random.uniform(-16, -3)),
                 share = random.chance(0.5) ? 0 : random.uniform(0.1, 0.9);
    const Vector by = ball();
    for (size_t k = 0; k < 3; ++k) {
      other[0][k] = face[0][k] + share * (face[1][k] - face[0][k]) + depth * by[k];
    }
    const auto interval = contact(face, other, {0.3, 0.2, 0.9});
    if (!interval || sign(interval->first) > 0 || sign(interval->last) < 0) continue;
    ++crossing;
    for (const Vector& point : {commonPoint(face, other), commonPoint(other, face)}) {
      for (const Triangle& triangle : {face, other}) {
        const long double off =
            distances::fromTriangle(distances::pointOf<long double>(point), distances::pointsOf<long double>(triangle));
        CAPTURE(round, depth);
        REQUIRE(static_cast<double>(off) < 1e-14);  // nor NaN
      }
    }
  }
  CHECK(crossing > 5'000);
}

TEST_CASE("edges that are parallel as far as double-doubles can tell have a normal") {
  // The edges are (m + 1, m, 0) and (m, m - 1, 0), whose cross product is (0, 0, -1).
  const double m = 0x1p60;
  const Event crossing = edgeEdge({0, 0, 3}, {-1, 0, 0}, {m, m, 0}, {0, 1, 5}, {m, m, 5});
  CHECK(normal(crossing) == Vector{0, 0, -1});
  // So that the tiny components underflow beside the large ones.
  const double tiny = 0x1p-1070;
  const Event flat = edgeEdge({0, 1, 0}, {0, 0, 0}, {m, 0, tiny}, {0, 5, 0}, {m, 5, 0});
  CHECK(normal(flat) == Vector{0, -1, 0});
}
