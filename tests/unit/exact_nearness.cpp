// Compares which pairs block a motion with a clearance with the definition, in integers and by another method: the
// least distance is that of the point nearest to the origin among all b - a - s d, which some corners of that set span.
#include "exact/nearness.h"

#include "cpu/approach.h"
#include "exact_oracle.h"
#include "soups.h"
#include "support/catch.h"

using oracle::cross;
using oracle::dot;
using oracle::Integer;
using oracle::IntVec;
using oracle::minus;
using radar::Vector;
using radar::exact::Triangle;
using soups::latticeTriangle;
using soups::Random;

namespace {

struct Ratio {
  Integer num, den;
};
bool isLess(const Ratio& p, const Ratio& q) {
  return p.num * q.den < q.num * p.den;
}

/// The square of the distance of the origin from all weighted means of `points`, plus `way` times any number >= 0.
Ratio squaredDistance(const std::vector<IntVec>& points, const IntVec* way) {
  Ratio least{-1, 0};
  const auto offer = [&](const IntVec& p0, const IntVec* e1, const IntVec* e2, bool isWay1, bool isWay2) {
    // The least |p0 + y1 e1 + y2 e2|, by Cramer's rule.
    Integer den = 1, y1 = 0, y2 = 0;
    if (e2 != nullptr) {
      const Integer g11 = dot(*e1, *e1), g12 = dot(*e1, *e2), g22 = dot(*e2, *e2), c1 = -dot(*e1, p0),
                    c2 = -dot(*e2, p0);
      den = g11 * g22 - g12 * g12;
      y1 = c1 * g22 - c2 * g12;
      y2 = c2 * g11 - c1 * g12;
    } else if (e1 != nullptr) {
      den = dot(*e1, *e1);
      y1 = -dot(*e1, p0);
    }
    if (den == 0 || y1 < 0 || y2 < 0) return;
    if ((isWay1 ? Integer(0) : y1) + (isWay2 ? Integer(0) : y2) > den) return;
    IntVec at;
    for (size_t k = 0; k < 3; ++k) {
      at[k] = den * p0[k] + (e1 != nullptr ? Integer(y1 * (*e1)[k]) : Integer(0)) +
              (e2 != nullptr ? Integer(y2 * (*e2)[k]) : Integer(0));
    }
    const Ratio found{dot(at, at), den * den};
    if (least.den == 0 || isLess(found, least)) least = found;
  };
  const auto contains = [&](const IntVec& p0, const IntVec& e1, const IntVec& e2, const IntVec& e3, bool isWay) {
    const auto det = [](const IntVec& x, const IntVec& y, const IntVec& z) { return dot(x, cross(y, z)); };
    Integer den = det(e1, e2, e3);
    if (den == 0) return false;
    const int sign = den < 0 ? -1 : 1;
    const Integer y1 = -sign * det(p0, e2, e3), y2 = -sign * det(e1, p0, e3), y3 = -sign * det(e1, e2, p0);
    den *= sign;
    return y1 >= 0 && y2 >= 0 && y3 >= 0 && y1 + y2 + (isWay ? Integer(0) : y3) <= den;
  };
  for (size_t i = 0; i < points.size(); ++i) {
    const IntVec& p = points[i];
    offer(p, nullptr, nullptr, false, false);
    if (way != nullptr) offer(p, way, nullptr, true, false);
    for (size_t j = i + 1; j < points.size(); ++j) {
      const IntVec e1 = minus(points[j], p);
      offer(p, &e1, nullptr, false, false);
      if (way != nullptr) offer(p, &e1, way, false, true);
      for (size_t k = j + 1; k < points.size(); ++k) {
        const IntVec e2 = minus(points[k], p);
        offer(p, &e1, &e2, false, false);
        if (way != nullptr && contains(p, e1, e2, *way, true)) return {0, 1};
        for (size_t l = k + 1; l < points.size(); ++l) {
          if (contains(p, e1, e2, minus(points[l], p), false)) return {0, 1};
        }
      }
    }
  }
  return least;
}

IntVec integers(const Vector& v) {
  return {Integer(std::lround(v[0])), Integer(std::lround(v[1])), Integer(std::lround(v[2]))};
}

/// By the definition, for a pair that is farther apart than the slack at the start.
bool blocks(const Ratio& start, const Ratio& least, const Integer& clearance, const Integer& slack) {
  const Integer room = clearance - slack;
  if (start.num >= clearance * clearance * start.den) return least.num < room * room * least.den;
  // sqrt(least) + slack < sqrt(start), squared twice.
  const Integer rest = start.num * least.den - least.num * start.den - slack * slack * start.den * least.den;
  return rest > 0 && 4 * slack * slack * least.num * least.den * start.den * start.den < rest * rest;
}

}  // namespace

TEST_CASE(
    "a pair blocks at a distance if it comes nearer than the clearance and than it starts, by more than the slack") {
  Random random(63);
  int blocking = 0, passing = 0, within = 0, constant = 0, told[4] = {};
  for (int i = 0; i < 6000; ++i) {
    INFO("pair " << i);
    const int side = random.integer(1, 4);
    Triangle a = latticeTriangle(random, side), b = latticeTriangle(random, side);
    if (random.chance(0.2)) a = {a[0], a[0], a[0]};
    if (random.chance(0.2)) b = {b[0], b[1], b[1]};
    const Vector direction = random.latticeVector(2);
    // Thirds of a lattice's step.
    for (Triangle* t : {&a, &b}) {
      for (Vector& c : *t) {
        for (double& x : c) x = 3 * std::round(x);
      }
    }
    const int clearance = random.integer(1, 12), slack = random.chance(0.5) ? 0 : random.integer(0, 3);
    std::vector<IntVec> differences;
    for (const Vector& p : a) {
      for (const Vector& q : b) differences.push_back(minus(integers(q), integers(p)));
    }
    const IntVec back = integers({-direction[0], -direction[1], -direction[2]});
    const Ratio start = squaredDistance(differences, nullptr), least = squaredDistance(differences, &back);
    const radar::exact::Course course{direction, 100, radar::exact::length(direction)};
    const double scale = std::ldexp(1.0, random.integer(-60, 60));
    Triangle scaledA = a, scaledB = b;
    for (Triangle* t : {&scaledA, &scaledB}) {
      for (Vector& c : *t) {
        for (double& x : c) x *= scale;
      }
    }
    const bool found = radar::exact::blocksWithin(scaledA, scaledB, {direction, 100 * scale, course.length},
                                                  clearance * scale, slack * scale, {});
    const bool touches = start.num <= Integer(slack * slack) * start.den || clearance <= slack;
    const bool truth = touches ? radar::exact::blocks(a, b, course, slack, {}) : blocks(start, least, clearance, slack);
    REQUIRE(found == truth);
    const auto roughly = radar::cpu::nearingOf(scaledA, scaledB, direction, clearance * scale, slack * scale);
    if (roughly == radar::cpu::Nearing::pressed) {
      REQUIRE(touches);
    } else if (roughly != radar::cpu::Nearing::open) {
      REQUIRE((!touches && (roughly == radar::cpu::Nearing::yes) == truth));
    }
    ++told[static_cast<size_t>(roughly)];
    ++(truth ? blocking : passing);
    within += !touches && start.num <= Integer(clearance * clearance) * start.den;
    constant += !touches && !isLess(least, start);
  }
  CAPTURE(blocking, passing, within, constant, told[0], told[1], told[2], told[3]);
  CHECK(blocking > 500);
  CHECK(passing > 500);
  CHECK(within > 300);
  CHECK(constant > 300);
  // Lattices are hard: triangles touch, and slide along each other.
  for (const int times : told) CHECK(times > 300);
  CHECK(told[3] < 2000);
}
