#include "cpu/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/double_double.h"
#include "exact/motion.h"

namespace radar::cpu {

namespace {

using exact::DoubleDouble;

// Steps converge quadratically, or by a factor of two where the triangles pass each other just within the clearance.
constexpr int kMostSteps = 200;
// More digits may tell whether triangles are within the clearance if less of it than this is known: of positions, as
// those of triangles a million times as large; of the distance, as that of needles, whose nearest points are not found.
constexpr double kFine = 0x1p-27, kTight = 0x1p-20;

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
using Point = std::array<Real, 3>;
template <class Real>
using Corners = std::array<Point<Real>, 3>;

template <class Real>
Point<Real> operator+(const Point<Real>& p, const Point<Real>& q) {
  return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
}
template <class Real>
Point<Real> operator-(const Point<Real>& p, const Point<Real>& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
template <class Real>
Point<Real> operator*(const Real& f, const Point<Real>& v) {
  return {f * v[0], f * v[1], f * v[2]};
}
template <class Real>
Real dot(const Point<Real>& p, const Point<Real>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}
template <class Real>
Point<Real> crossProduct(const Point<Real>& p, const Point<Real>& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
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

/// The nearest pair of points found so far.
template <class Real>
struct Nearest {
  Point<Real> a{}, b{};
  exact::Features features{Feature::vertex, Feature::vertex};
  size_t corner = 0;  ///< of b, if that is a vertex
  Real squared{Of<Real>::never};

  void offer(const Point<Real>& p, const Point<Real>& q, const exact::Features& on, size_t cornerOfB = 0) {
    const Point<Real> gap = q - p;
    if (const Real d = dot(gap, gap); d < squared) *this = {p, q, on, cornerOfB, d};
  }
};

/// The feature on which the point at a share of an edge is.
template <class Real>
Feature featureAt(const Real& share) {
  return share > Real{} && share < Real{1} ? Feature::edge : Feature::vertex;
}

// The points need not be the nearest: any will do for the bounds, but these make them tight. Cross products lose far
// fewer digits than the squares of a Gram matrix if a triangle is a needle.

template <class Real>
Real share(const Real& part, const Real& whole) {
  return whole > Real{} ? std::clamp(part / whole, Real{}, Real{1}) : Real{};
}

/// Edge i of a and edge k of b.
template <class Real>
void offerEdges(Nearest<Real>& nearest, const Corners<Real>& a, size_t i, const Corners<Real>& b, size_t k) {
  const size_t end = (k + 1) % 3;
  const Point<Real>&a0 = a[i], &b0 = b[k];
  const Point<Real> x = a[(i + 1) % 3] - a0, y = b[end] - b0, r = b0 - a0, n = crossProduct(x, y);
  const Real nn = dot(n, n), xx = dot(x, x), yy = dot(y, y);
  Real s = share(dot(crossProduct(r, y), n), nn);
  Real t = share(dot(a0 + s * x - b0, y), yy);
  s = share(dot(b0 + t * y - a0, x), xx);
  t = share(dot(a0 + s * x - b0, y), yy);
  nearest.offer(a0 + s * x, b0 + t * y, {featureAt(s), featureAt(t)}, t > Real{} ? end : k);
}

/// The point of a face at `p`, as seen along its normal; none if it is outside.
template <class Real>
std::optional<Point<Real>> onFace(const Point<Real>& p, const Corners<Real>& face) {
  const Point<Real> x = face[1] - face[0], y = face[2] - face[0], r = p - face[0], n = crossProduct(x, y);
  const Real nn = dot(n, n);
  if (!(nn > Real{})) return std::nullopt;
  const Real v = dot(crossProduct(r, y), n) / nn, w = dot(crossProduct(x, r), n) / nn;
  if (!(v >= Real{} && w >= Real{} && v + w <= Real{1})) return std::nullopt;
  return face[0] + v * x + w * y;
}

/// Where an edge crosses a face: the points of both, which rounding may keep apart.
template <class Real>
struct Crossing {
  Point<Real> onEdge, onFace;
};
template <class Real>
std::optional<Crossing<Real>> crossing(const Point<Real>& p, const Point<Real>& q, const Corners<Real>& face) {
  const Point<Real> n = crossProduct(face[1] - face[0], face[2] - face[0]);
  const Real before = dot(n, p - face[0]), after = dot(n, q - face[0]);
  if (!(before * after < Real{})) return std::nullopt;
  const Point<Real> at = p + std::clamp(before / (before - after), Real{}, Real{1}) * (q - p);
  const auto above = onFace(at, face);
  return above ? std::optional(Crossing<Real>{at, *above}) : std::nullopt;
}

template <class Real>
Nearest<Real> nearestPoints(const Corners<Real>& a, const Corners<Real>& b) {
  Nearest<Real> nearest{a[0], b[0]};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) offerEdges(nearest, a, i, b, k);
    if (const auto p = onFace(a[i], b)) nearest.offer(a[i], *p, {Feature::vertex, Feature::face});
    if (const auto p = onFace(b[i], a)) nearest.offer(*p, b[i], {Feature::face, Feature::vertex}, i);
    if (const auto at = crossing(a[i], a[(i + 1) % 3], b)) {
      nearest.offer(at->onEdge, at->onFace, {Feature::edge, Feature::face});
    }
    if (const auto at = crossing(b[i], b[(i + 1) % 3], a)) {
      nearest.offer(at->onFace, at->onEdge, {Feature::face, Feature::edge});
    }
  }
  return nearest;
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
};

template <class Real>
Moment<Real> momentAt(const Pair<Real>& pair, const Real& t) {
  const auto& [edges, gaps, unit, clearance, distance, tolerance] = pair;
  Corners<Real> b;
  for (size_t k = 0; k < 3; ++k) b[k] = gaps[k] - t * unit;
  Moment<Real> m{.nearest = nearestPoints(edges, b)};
  // Differences, the motion and its direction lose less than 16u of these numbers; the nearest points, whatever their
  // weights, and inner products with a unit vector less than 16u more.
  double size = Of<Real>::rounded(t);
  for (size_t k = 0; k < 3; ++k) size = std::max({size, norm1(gaps[k]), norm1(b[k]), norm1(edges[k])});
  m.error = Real{64 * Of<Real>::unit * size + std::numeric_limits<double>::min()};
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

/// When a pair comes within the clearance, in the units of the pair.
template <class Real>
struct Found {
  Real lo{}, hi{Of<Real>::never};
  std::optional<Moment<Real>> atLo;  ///< if `hi` is known
  bool isRough = false;              ///< more digits may help
};

template <class Real>
std::optional<Found<Real>> search(const Pair<Real>& pair) {
  constexpr Real kNever{Of<Real>::never}, kHalf{0.5};
  // Of a rate: of two unit vectors and their inner product.
  constexpr Real kRateError{64 * Of<Real>::unit};
  const Real& clearance = pair.clearance;
  Found<Real> found;
  // The distance is convex in t. So contact fills one interval, which lies between found.lo and `end`.
  Real t{}, end = kNever, step{}, approaching{}, receding = kNever;
  for (int i = 0; i < kMostSteps; ++i) {
    const Moment<Real> m = momentAt(pair, t);
    const Real least = std::max(kHalf * pair.tolerance, Real{4} * m.error);
    if (m.most <= clearance) {
      found.hi = t;
      found.atLo = t > Real{} ? momentAt(pair, found.lo) : m;
      return found;
    }
    if (m.least > clearance) {
      // No contact while the plane, which moves at a constant rate, is farther than the clearance.
      const Real spare = (m.least - clearance) * (Real{1} - Real{16 * Of<Real>::unit}), forward = m.rate + kRateError,
                 backward = kRateError - m.rate;
      const Real from = backward > Real{} ? t - spare / backward : -kNever;
      const Real to = forward > Real{} ? t + spare / forward : kNever;
      if (from <= found.lo) {
        found.lo = std::max(found.lo, to * (Real{1} - Real{4 * Of<Real>::unit}));
      } else if (to >= end || to >= kNever) {
        end = std::min(end, from * (Real{1} + Real{4 * Of<Real>::unit}));
      } else {
        return found;
      }
      if (found.lo > pair.distance || found.lo >= end) return std::nullopt;
      step = least;
      const Real next = std::min({found.lo + step, kHalf * found.lo + kHalf * end, pair.distance});
      // A motion along the plane leaves no room for another step.
      if (next == t) return found;
      t = next;
    } else {
      // Rounding leaves open whether the triangles are within the clearance now. They are nearest to each other between
      // where they still approach and where they move apart.
      found.isRough = found.isRough || m.error > Real{kFine} * clearance || m.most - m.least > Real{kTight} * clearance;
      const bool isApproaching = m.rate + kRateError > Real{};
      if (isApproaching) approaching = std::max(approaching, t);
      if (!isApproaching) receding = std::min(receding, t);
      const Real from = std::max(found.lo, approaching), to = std::min(end, receding);
      step = std::max(Real{2} * step, least);
      const Real next =
          isApproaching ? std::min({t + step, kHalf * t + kHalf * to, pair.distance}) : kHalf * from + kHalf * t;
      if (next == t || !(to - from > m.error)) return found;
      t = next;
    }
  }
  return found;
}

double difference(double p, double q, double) {
  return p - q;
}
DoubleDouble difference(double p, double q, const DoubleDouble&) {
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
Point<DoubleDouble> normalised(const Vector& direction) {
  const int exponent = std::ilogb(largest(direction));
  Point<DoubleDouble> d;
  for (size_t k = 0; k < 3; ++k) d[k].high = std::ldexp(direction[k], -exponent);
  return (DoubleDouble{1} / exact::root(dot(d, d))) * d;
}

/// Outwards.
double roundedDown(double x) {
  return x;
}
double roundedUp(double x) {
  return x;
}
double roundedDown(const DoubleDouble& x) {
  return (1 - 2 * kUnit) * x.high;
}
double roundedUp(const DoubleDouble& x) {
  return x.high < Of<DoubleDouble>::never ? (1 + 2 * kUnit) * x.high : std::numeric_limits<double>::infinity();
}

template <class Real>
Approach inWorld(const Found<Real>& found, const exact::Triangle& a, const exact::Triangle& b, const Point<Real>& unit,
                 double unscale) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Approach out{
      unscale * roundedDown(found.lo), unscale * roundedUp(found.hi), {kNan, kNan, kNan}, {kNan, kNan, kNan}, {}};
  if (!found.atLo) return out;
  const Nearest<Real>& nearest = found.atLo->nearest;
  out.features = nearest.features;
  if (nearest.features.b == Feature::vertex) {
    out.point = b[nearest.corner];
  } else {
    const Real lo = Real{unscale} * found.lo;
    out.point = rounded(exactly<Real>(a[0]) + lo * unit + Real{unscale} * nearest.b);
  }
  const Point<Real> gap = nearest.a - nearest.b;
  if (found.atLo->least > Real{}) out.normal = rounded((Real{1} / Of<Real>::root(dot(gap, gap))) * gap);
  return out;
}

}  // namespace

std::optional<Approach> approach(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction,
                                 const Vector& unit, double clearance, double distance, double tolerance) {
  double size = clearance;
  for (size_t i = 0; i < 3; ++i) size = std::max({size, norm1(a[i] - a[0]), norm1(b[i] - a[0])});
  // Scaled by a power of two to about 1, so that products neither overflow nor underflow.
  const int exponent = std::clamp(std::ilogb(size), -1000, 1000);
  const double scale = std::ldexp(1.0, -exponent), unscale = std::ldexp(1.0, exponent);
  const Pair<double> rough{relative<double>(a, a[0], scale),
                           relative<double>(b, a[0], scale),
                           unit,
                           scale * clearance,
                           scale * distance,
                           scale * tolerance};
  const auto found = search(rough);
  if (!found) return std::nullopt;
  if (!found->isRough || found->hi - found->lo <= rough.tolerance) return inWorld(*found, a, b, unit, unscale);
  const Pair<DoubleDouble> fine{relative<DoubleDouble>(a, a[0], scale),
                                relative<DoubleDouble>(b, a[0], scale),
                                normalised(direction),
                                {rough.clearance},
                                {std::min(rough.distance, 1e290)},
                                {rough.tolerance}};
  const auto better = search(fine);
  return better ? std::optional(inWorld(*better, a, b, fine.unit, unscale)) : std::nullopt;
}

}  // namespace radar::cpu
