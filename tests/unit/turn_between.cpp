// Turns from two poses, against rotations in long doubles.
#include <cmath>

#include "radar/displacement.h"
#include "radar/error.h"
#include "support/catch.h"
#include "workloads/random.h"
#include "workloads/vectors.h"

using namespace radar;
using namespace radar::tools;

namespace {

constexpr double kPi = 3.14159265358979323846;
using Real = long double;
using Point = std::array<Real, 3>;

Point turned(const Vec3& unitAxis, double angle, const Point& p) {
  const Real sine = std::sin(Real(angle)), half = std::sin(Real(angle) / 2), back = 2 * half * half;
  const auto cross = [&](const Point& v) {
    return Point{unitAxis[1] * v[2] - unitAxis[2] * v[1], unitAxis[2] * v[0] - unitAxis[0] * v[2],
                 unitAxis[0] * v[1] - unitAxis[1] * v[0]};
  };
  const Point across = cross(p), inwards = cross(across);
  Point out;
  for (size_t k = 0; k < 3; ++k) out[k] = p[k] + sine * across[k] + back * inwards[k];
  return out;
}

Point placed(const Transform& pose, const Vec3& p) {
  Point out;
  for (size_t k = 0; k < 3; ++k) {
    out[k] = Real(pose.m[4 * k]) * p[0] + Real(pose.m[4 * k + 1]) * p[1] + Real(pose.m[4 * k + 2]) * p[2] +
             pose.m[4 * k + 3];
  }
  return out;
}

/// The pose after a turn about the place of `about`, which goes by `way`.
Transform after(const Transform& start, const Vec3& unitAxis, double angle, const Vec3& about, const Vec3& way) {
  const Point centre = placed(start, about);
  Transform end;
  for (size_t column = 0; column < 4; ++column) {
    Point v;
    for (size_t k = 0; k < 3; ++k) v[k] = start.m[4 * k + column] - (column == 3 ? centre[k] : 0);
    v = turned(unitAxis, angle, v);
    for (size_t k = 0; k < 3; ++k) end.m[4 * k + column] = double(v[k] + (column == 3 ? centre[k] + way[k] : 0));
  }
  return end;
}

double farthest(const Point& a, const Point& b) {
  Real most = 0;
  for (size_t k = 0; k < 3; ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return double(most);
}

Vec3 unitVector(Random& random) {
  const Rotation rotation = random.rotation();
  return {rotation[0], rotation[1], rotation[2]};
}

}  // namespace

TEST_CASE("two poses give the turn and the motion between them, of small angles as of nearly half turns") {
  Random random(67);
  for (int i = 0; i < 3000; ++i) {
    CAPTURE(i);
    const Vec3 axis = unitVector(random);
    const double angle = i % 3 == 0   ? std::ldexp(random.uniform(1, 2), -40 + i % 40)
                         : i % 3 == 1 ? kPi - std::ldexp(random.uniform(1, 2), -30 + i % 30)
                                      : random.uniform(0.1, 3);
    const double size = std::ldexp(1.0, i % 41 - 20);
    const auto vector = [&](double most) {
      return Vec3{random.uniform(-most, most), random.uniform(-most, most), random.uniform(-most, most)};
    };
    const Vec3 scale = i % 2 == 0 ? Vec3{size, size, size} : Vec3{size, -0.5 * size, 3 * size};
    const Transform start = makePose(random.rotation(), scale, vector(i % 5 == 0 ? 1e6 * size : size));
    const Vec3 about = vector(2), way = i % 7 == 0 ? Vec3{} : vector(size);
    const Transform end = after(start, axis, angle, about, way);
    const auto [turn, motion] = turnBetween(start, end, about);
    CHECK(std::abs(turn.angle - angle) < 2e-14);
    const double room =
        2e-15 * std::max({std::abs(start.m[3]), std::abs(start.m[7]), std::abs(start.m[11]), 10 * size});
    CHECK(farthest(placed(start, about), {turn.centre[0], turn.centre[1], turn.centre[2]}) < room);
    CHECK(farthest({way[0], way[1], way[2]}, {motion[0], motion[1], motion[2]}) < room);
    // What matters: it ends where it should.
    const Vec3 found = (1 / lengthOf(turn.axis)) * turn.axis, corner = vector(1);
    Point p = placed(start, corner);
    for (size_t k = 0; k < 3; ++k) p[k] -= turn.centre[k];
    p = turned(found, turn.angle, p);
    for (size_t k = 0; k < 3; ++k) p[k] += turn.centre[k] + motion[k];
    CHECK(farthest(p, placed(end, corner)) < 10 * room);
  }
}

TEST_CASE("poses that differ by their places alone give no turn") {
  Random random(68);
  Transform start = makePose(random.rotation(), {1, 2, -3}, {1, 2, 3});
  start.m[1] += 0.7;  // shear
  Transform end = start;
  for (size_t k = 0; k < 3; ++k) end.m[4 * k + 3] += 0.5;
  const auto [turn, motion] = turnBetween(start, end, {5, 6, 7});
  CHECK(turn.angle == 0);
  CHECK(motion == Vec3{0.5, 0.5, 0.5});
}

TEST_CASE("half turns, of which nobody knows the way, and what is no turn are refused") {
  Random random(69);
  const auto turn = [](const Transform& start, const Transform& end, const Vec3& about = {}) {
    return turnBetween(start, end, about);
  };
  for (int i = 0; i < 500; ++i) {
    const Transform start = makePose(random.rotation(), {2, 2, 2}, {1, 2, 3});
    const Vec3 axis = unitVector(random);
    CHECK_THROWS_WITH(turn(start, after(start, axis, kPi, {}, {})), test::Contains("expected less than half a turn"));
    CHECK(turn(start, after(start, axis, kPi - 1e-12, {}, {})).turn.angle < kPi);
  }
  const Transform start = makePose(random.rotation(), {1, 1, 1}, {});
  const auto scaledBy = [&](const Vec3& by) { return makePose(linearPart(start), by, {}); };
  for (const double by : {2.0, std::sqrt(2.0), 1e200, 1e-100}) {
    CHECK_THROWS_WITH(turn(start, scaledBy({by, by, by})), test::Contains("scaled or sheared, by"));
  }
  CHECK_THROWS_WITH(turn(start, scaledBy({1, 1, 1.0001})), test::Contains("scaled or sheared, by 0.000"));
  CHECK_NOTHROW(turn(start, scaledBy({1, 1, 1 + 1e-7})));
  CHECK_THROWS_WITH(turn(start, scaledBy({1, 1, -1})), test::Contains("its mirror image"));
  CHECK_THROWS_WITH(turn(start, scaledBy({1, 1, 0})), test::StartsWith("turnBetween: end: expected"));
  CHECK_THROWS_WITH(turn(scaledBy({1, NAN, 1}), start), test::StartsWith("turnBetween: start: expected"));
  CHECK_THROWS_WITH(turn(start, start, {NAN, 0, 0}), test::StartsWith("turnBetween: about: expected"));
  // A mirrored body turns like any other.
  CHECK(turn(scaledBy({-1, 1, 1}), scaledBy({-1, 1, 1})).turn.angle == 0);
}
