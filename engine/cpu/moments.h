// Two triangles, one of them in motion, at a moment: bounds on their distance and on how fast it falls, in doubles and
// in double-doubles (docs/exact.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu/approach.h"
#include "exact/double_double.h"
#include "exact/nearest_points.h"

namespace radar::cpu::moments {

using exact::Corners, exact::DoubleDouble, exact::dot, exact::Nearest, exact::nearestPoints, exact::Point;
using exact::operator+, exact::operator-, exact::operator*;

// More digits may tell whether triangles are within the clearance if less of it than this is known: of positions, as
// those of triangles a million times as large. Likewise if the bounds on the distance differ by more of the positions'
// error than this: the nearest points are those of the least square, which tells them to some 2^-26 only, or those of
// needles, which are not found.
inline constexpr double kFine = 0x1p-27, kTight = 16;

/// What the search needs of a number. It is written once, for doubles and for double-doubles.
template <class Real>
struct Of;
template <>
struct Of<double> {
  static constexpr double unit = kUnit;  ///< a sum, product, quotient or root is off by at most this
  static constexpr double never = std::numeric_limits<double>::infinity();
  static double root(double x) { return std::sqrt(x); }
  static double rounded(double x) { return x; }
};
template <>
struct Of<DoubleDouble> {
  static constexpr double unit = 0x1p-102;
  static constexpr double never = 1e300;  // infinity would not survive their sums
  static DoubleDouble root(const DoubleDouble& x) { return exact::root(x); }
  static double rounded(const DoubleDouble& x) { return x.high; }
};

template <class Real>
Vector rounded(const Point<Real>& p) {
  return {Of<Real>::rounded(p[0]), Of<Real>::rounded(p[1]), Of<Real>::rounded(p[2])};
}
template <class Real>
double norm1(const Point<Real>& p) {
  return radar::norm1(rounded(p));
}
template <class Real>
Point<Real> exactly(const Vector& v) {
  return {Real{v[0]}, Real{v[1]}, Real{v[2]}};
}

/// The triangles at one moment.
template <class Real>
struct Moment {
  Nearest<Real> nearest;  // relative to corner 0 of the moving triangle
  Real least, most;       // bounds on their distance
  Real rate;              // of a bound that `least` gives on all distances: the decrease per unit of motion
  Real error;             // of positions
};

/// Two triangles, relative to corner 0 of the moving one and scaled by a power of two, and how they are to meet.
template <class Real>
struct Pair {
  Corners<Real> edges, gaps;  ///< the moving one; the resting one
  Point<Real> unit;
  Real clearance, distance, tolerance;
  double size = 0;  ///< the greatest of the numbers that the others come from
};

// Lengths are at most 2 but for the way: triangles that have moved farther than this move apart, and are apart by more
// than a clearance.
inline constexpr double kPast = 8;

/// `first`: where the nearest points may be.
template <class Real>
Moment<Real> momentAt(const Pair<Real>& pair, const Real& t, exact::FeaturePlace first = exact::kAnyPlace) {
  const Corners<Real>&edges = pair.edges, &gaps = pair.gaps;
  const Point<Real>& unit = pair.unit;
  Moment<Real> m;
  Corners<Real> b;
  for (size_t k = 0; k < 3; ++k) b[k] = gaps[k] - t * unit;
  // Differences, the motion and its direction lose less than 16u of these numbers; the nearest points, whatever their
  // weights, and inner products with a unit vector less than 16u more.
  double size = std::max(Of<Real>::rounded(t), pair.size);
  for (size_t k = 0; k < 3; ++k) size = std::max({size, norm1(gaps[k]), norm1(b[k]), norm1(edges[k])});
  m.error = Real{64 * Of<Real>::unit * size + std::numeric_limits<double>::min()};
  m.nearest = nearestPoints(edges, b, Real{0.5} * m.error, first);
  const Point<Real> gap = m.nearest.b - m.nearest.a;
  const Real length = Of<Real>::root(dot(gap, gap));
  m.most = length + m.error;
  m.least = Real{};
  m.rate = Real{1};
  if (!(length > Real{} && length < Real{Of<Real>::never})) return m;
  // A plane across the line between the nearest points keeps the triangles apart, now and until the motion has used up
  // its distance.
  const Point<Real> n = (Real{1} / length) * gap;
  const Real from = std::max({dot(n, edges[0]), dot(n, edges[1]), dot(n, edges[2])});
  const Real to = std::min({dot(n, b[0]), dot(n, b[1]), dot(n, b[2])});
  m.least = std::max(to - from - m.error, Real{});
  m.rate = dot(n, unit);
  return m;
}

/// Of a rate: of two unit vectors and their inner product.
template <class Real>
inline constexpr Real kRateError{64 * Of<Real>::unit};

inline double difference(double p, double q, double) {
  return p - q;
}
inline DoubleDouble difference(double p, double q, const DoubleDouble&) {
  return exact::difference(p, q);
}

/// A triangle relative to a point.
template <class Real>
Corners<Real> relative(const exact::Triangle& triangle, const Vector& origin, double scale) {
  Corners<Real> out;
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) out[i][k] = Real{scale} * difference(triangle[i][k], origin[k], Real{});
  }
  return out;
}

/// A direction of length 1.
inline Point<DoubleDouble> normalised(const Vector& direction) {
  const int exponent = std::ilogb(largest(direction));
  Point<DoubleDouble> d;
  for (size_t k = 0; k < 3; ++k) d[k].high = std::ldexp(direction[k], -exponent);
  return (DoubleDouble{1} / exact::root(dot(d, d))) * d;
}

/// Outwards.
inline double roundedDown(double x) {
  return x;
}
inline double roundedUp(double x) {
  return x;
}
inline double roundedDown(const DoubleDouble& x) {
  return (1 - 2 * kUnit) * x.high;
}
inline double roundedUp(const DoubleDouble& x) {
  return x.high < Of<DoubleDouble>::never ? (1 + 2 * kUnit) * x.high : std::numeric_limits<double>::infinity();
}

/// Times a power of two, outwards where that rounds.
inline double unscaledDown(double x, double unscale) {
  const double out = unscale * x;
  return x > 0 && out < std::numeric_limits<double>::min()
             ? std::max(out - std::numeric_limits<double>::denorm_min(), 0.0)
             : out;
}
inline double unscaledUp(double x, double unscale) {
  const double out = unscale * x;
  return x > 0 && out < std::numeric_limits<double>::min() ? out + std::numeric_limits<double>::denorm_min() : out;
}

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Of triangle a, moved by `way` along the unit vector, and b.
template <class Real>
Separation inWorld(const Moment<Real>& moment, const Real& way, const exact::Triangle& a, const exact::Triangle& b,
                   const Point<Real>& unit, double unscale) {
  const Nearest<Real>& nearest = moment.nearest;
  const Point<Real> gap = nearest.a - nearest.b;
  const Real length = Of<Real>::root(dot(gap, gap));
  Separation out{unscale * Of<Real>::rounded(length), {}, {kNan, kNan, kNan}, nearest.features};
  if (nearest.features.b == Feature::vertex) {
    out.point = b[nearest.corner];
  } else {
    out.point = rounded(exactly<Real>(a[0]) + Real{unscale} * way * unit + Real{unscale} * nearest.b);
  }
  // The points tell, even where a plane across the line between them, tilted by rounding, no longer keeps apart all.
  if (length > moment.error) out.normal = rounded((Real{1} / length) * gap);
  return out;
}

/// Exponent of a power of two that scales lengths up to about `size` to 1, so that products neither overflow nor
/// underflow.
inline int exponentOf(const exact::Triangle& a, const exact::Triangle& b, double size) {
  for (size_t i = 0; i < 3; ++i) size = std::max({size, norm1(a[i] - a[0]), norm1(b[i] - a[0])});
  return std::clamp(std::ilogb(size), -1000, 1000);
}

inline Pair<double> roughPair(const exact::Triangle& a, const exact::Triangle& b, const Translation& motion,
                              double clearance, double tolerance, double scale) {
  return {relative<double>(a, a[0], scale),
          relative<double>(b, a[0], scale),
          motion.unit,
          scale * clearance,
          scale * motion.wayUntil(motion.end),
          scale * tolerance};
}

/// How far a step goes, scaled and rounded up. A double is above it by more than double-doubles lose.
inline DoubleDouble wayOf(const Vector& displacement, double scale) {
  const int exponent = std::ilogb(largest(displacement));
  Point<DoubleDouble> d;
  for (size_t k = 0; k < 3; ++k) d[k].high = std::ldexp(displacement[k], -exponent);
  const DoubleDouble length = DoubleDouble{1, 0x1p-99} * exact::root(dot(d, d));
  const double unscale = scale * std::ldexp(1.0, exponent);
  return {unscale * length.high, unscale * length.low};
}

inline Pair<DoubleDouble> finePair(const Pair<double>& rough, const exact::Triangle& a, const exact::Triangle& b,
                                   const Translation& motion, double scale) {
  DoubleDouble distance{std::min(rough.distance, 1e290)};
  if (motion.isStep) distance = motion.stands ? DoubleDouble{} : std::min(distance, wayOf(motion.direction, scale));
  return {relative<DoubleDouble>(a, a[0], scale),
          relative<DoubleDouble>(b, a[0], scale),
          normalised(motion.direction),
          {rough.clearance},
          distance,
          {rough.tolerance}};
}

}  // namespace radar::cpu::moments
