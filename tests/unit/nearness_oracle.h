// The oracle for how near triangles come to each other: exact, in integers, and by another method than the engine's.
// The least distance is that of the point nearest to the origin among all b - a - s d, which some corners of that set
// span.
#pragma once

#include "exact_oracle.h"

namespace oracle {

/// num / den, den > 0.
struct Ratio {
  Integer num, den;
};
inline bool isLess(const Ratio& p, const Ratio& q) {
  return p.num * q.den < q.num * p.den;
}

/// The square of the distance of the origin from all weighted means of `points`, plus `way` times any number >= 0.
inline Ratio squaredDistance(const std::vector<IntVec>& points, const IntVec* way) {
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

/// The squares of the distances of two triangles at the start and, at the least, from then on. A direction of 0: at
/// rest.
struct Nearness {
  Ratio start, least;
};
inline Nearness nearnessOf(const IntTriangle& a, const IntTriangle& b, const IntVec& direction) {
  std::vector<IntVec> differences;
  for (const IntVec& p : a) {
    for (const IntVec& q : b) differences.push_back(minus(q, p));
  }
  const IntVec back{Integer(-direction[0]), Integer(-direction[1]), Integer(-direction[2])};
  const Ratio start = squaredDistance(differences, nullptr);
  return {start, isZero(direction) ? start : squaredDistance(differences, &back)};
}

/// Whether a pair that is farther apart than the slack at the start comes nearer by more than that than it starts, and
/// than the clearance.
inline bool comesNearer(const Nearness& nearness, const Integer& clearance, const Integer& slack) {
  const auto& [start, least] = nearness;
  const Integer room = clearance - slack;
  if (start.num >= clearance * clearance * start.den) return least.num < room * room * least.den;
  // sqrt(least) + slack < sqrt(start), squared twice.
  const Integer rest = start.num * least.den - least.num * start.den - slack * slack * start.den * least.den;
  return rest > 0 && 4 * slack * slack * least.num * least.den * start.den * start.den < rest * rest;
}

}  // namespace oracle
