// The oracle: whether and when two triangles meet along a direction, in exact integers and by another method than the
// engine's. The engine finds the ends of the contact interval among vertices over faces and crossings of edges. The
// oracle intersects the intervals that separating axes of the difference set b - a allow: for each axis n, min(n.b) -
// max(n.a) <= s n.d <= max(n.b) - min(n.a). Enough axes together describe the set exactly.
#pragma once

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <optional>
#include <vector>

#include "radar/radar.h"

namespace oracle {

// As long as needed; most fit the 768 bits that cost no allocation.
using Integer = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<768>>;
using Rational =
    boost::multiprecision::number<boost::multiprecision::rational_adaptor<boost::multiprecision::cpp_int_backend<768>>>;

/// The least and the greatest number to which `rounded` may be the nearest double.
inline std::array<Rational, 2> roundedTo(double rounded) {
  return {(Rational(std::nextafter(rounded, -INFINITY)) + Rational(rounded)) / 2,
          (Rational(std::nextafter(rounded, INFINITY)) + Rational(rounded)) / 2};
}

using Corner = std::array<double, 3>;
using Corners = std::array<Corner, 3>;

/// num / den, den > 0, not reduced.
struct Fraction {
  Integer num, den = 1;
  int sign() const { return num.sign(); }
};

inline int compare(const Fraction& p, const Fraction& q) {
  return Integer(p.num * q.den).compare(Integer(q.num * p.den));
}

/// A double is mantissa * 2^exponent. Relative to the least exponent of a set, all its doubles are integers.
inline int leastExponent(const double* values, size_t count) {
  int least = 2000;
  for (size_t i = 0; i < count; ++i) {
    if (values[i] == 0) continue;
    int e;
    std::frexp(values[i], &e);
    least = std::min(least, e - 53);
  }
  return least == 2000 ? 0 : least;
}

inline Integer scaled(double value, int exponent) {
  if (value == 0) return 0;
  int e;
  const double m = std::frexp(value, &e);
  return Integer(static_cast<long long>(std::ldexp(m, 53))) << (e - 53 - exponent);
}

using IntVec = std::array<Integer, 3>;

inline IntVec cross(const IntVec& p, const IntVec& q) {
  return {Integer(p[1] * q[2] - p[2] * q[1]), Integer(p[2] * q[0] - p[0] * q[2]), Integer(p[0] * q[1] - p[1] * q[0])};
}

inline Integer dot(const IntVec& p, const IntVec& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

inline IntVec minus(const IntVec& p, const IntVec& q) {
  return {Integer(p[0] - q[0]), Integer(p[1] - q[1]), Integer(p[2] - q[2])};
}

inline bool isZero(const IntVec& v) {
  return v[0] == 0 && v[1] == 0 && v[2] == 0;
}

using IntTriangle = std::array<IntVec, 3>;

inline IntVec scaled(const Corner& p, int exponent) {
  return {scaled(p[0], exponent), scaled(p[1], exponent), scaled(p[2], exponent)};
}

inline IntTriangle scaled(const Corners& corners, int exponent) {
  return {scaled(corners[0], exponent), scaled(corners[1], exponent), scaled(corners[2], exponent)};
}

/// Makes of a parameter between scaled positions, along a scaled direction, that between unscaled ones.
inline void unscale(Fraction& s, int scale, int directionScale) {
  (scale >= directionScale ? s.num : s.den) <<= std::abs(scale - directionScale);
}

struct Interval {
  Fraction first, last;
};

/// Keeps the s of the interval with lo <= s * speed <= hi; no interval: all s. Returns whether any are left.
inline bool allow(std::optional<Interval>& interval, Integer lo, Integer hi, Integer speed) {
  if (speed == 0) return lo <= 0 && hi >= 0;
  if (speed < 0) {
    speed = -speed;
    std::swap(lo, hi);
    lo = -lo;
    hi = -hi;
  }
  const Fraction from{lo, speed}, to{hi, speed};
  if (!interval) {
    interval = Interval{from, to};
  } else {
    if (compare(from, interval->first) > 0) interval->first = from;
    if (compare(to, interval->last) < 0) interval->last = to;
  }
  return compare(interval->first, interval->last) <= 0;
}

namespace detail {

inline std::vector<IntVec> axesFor(const IntTriangle& a, const IntTriangle& b) {
  std::vector<IntVec> edges, axes;
  for (int i = 0; i < 3; ++i) edges.push_back(minus(a[(i + 1) % 3], a[i]));
  for (int i = 0; i < 3; ++i) edges.push_back(minus(b[(i + 1) % 3], b[i]));
  axes.push_back(cross(edges[0], edges[1]));
  axes.push_back(cross(edges[3], edges[4]));
  for (int i = 0; i < 3; ++i) {
    for (int k = 3; k < 6; ++k) axes.push_back(cross(edges[i], edges[k]));
  }
  std::erase_if(axes, isZero);
  const bool solid = std::any_of(axes.begin(), axes.end(), [&](const IntVec& n) { return !isZero(cross(n, axes[0])); });
  if (solid) return axes;
  // The difference set is flat, a segment or a point: add axes for its rims within the plane or line, and axes across
  // it.
  const std::vector<IntVec> normals = axes;
  const std::array<IntVec, 3> units{IntVec{1, 0, 0}, IntVec{0, 1, 0}, IntVec{0, 0, 1}};
  for (const IntVec& e : edges) {
    for (const IntVec& n : normals) axes.push_back(cross(e, n));
    for (const IntVec& u : units) axes.push_back(cross(e, u));
    axes.push_back(e);
  }
  for (const IntVec& u : units) axes.push_back(u);
  std::erase_if(axes, isZero);
  return axes;
}

}  // namespace detail

/// The interval of s in which a + s * direction meets b, all scaled.
inline std::optional<Interval> contact(const IntTriangle& a, const IntTriangle& b, const IntVec& direction) {
  std::optional<Interval> out;
  for (const IntVec& n : detail::axesFor(a, b)) {
    std::array<Integer, 3> onA{dot(n, a[0]), dot(n, a[1]), dot(n, a[2])};
    std::array<Integer, 3> onB{dot(n, b[0]), dot(n, b[1]), dot(n, b[2])};
    std::sort(onA.begin(), onA.end());
    std::sort(onB.begin(), onB.end());
    if (!allow(out, onB[0] - onA[2], onB[2] - onA[0], dot(n, direction))) return std::nullopt;
  }
  return out;
}

/// The interval of s in which a + s * direction meets b.
inline std::optional<Interval> contact(const Corners& a, const Corners& b, const Corner& direction) {
  std::vector<double> all;
  for (const Corners* t : {&a, &b}) {
    for (const Corner& c : *t) all.insert(all.end(), c.begin(), c.end());
  }
  const int scale = leastExponent(all.data(), all.size()), dirScale = leastExponent(direction.data(), 3);
  std::optional<Interval> out = contact(scaled(a, scale), scaled(b, scale), scaled(direction, dirScale));
  if (!out) return out;
  for (Fraction* f : {&out->first, &out->last}) unscale(*f, scale, dirScale);
  return out;
}

/// Sign of s * |direction| - distance, for s >= 0 and distance >= 0.
inline int compareToDistance(const Fraction& s, const Corner& direction, double distance) {
  const int dirScale = leastExponent(direction.data(), 3), scale = leastExponent(&distance, 1);
  const IntVec d = scaled(direction, dirScale);
  const Integer whole = scaled(distance, scale);
  Integer left = s.num * s.num * dot(d, d), right = s.den * s.den * whole * whole;
  (dirScale >= scale ? left : right) <<= 2 * std::abs(dirScale - scale);
  return left.compare(right);
}

inline Corners corners(const radar::MeshView& mesh, const radar::Transform& pose, uint32_t triangle) {
  Corners out;
  for (int i = 0; i < 3; ++i) out[i] = radar::transformPoint(pose, &mesh.positions[3 * mesh.indices[3 * triangle + i]]);
  return out;
}

}  // namespace oracle
