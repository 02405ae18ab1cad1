#include "cpu/approach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/motion.h"

namespace radar::cpu {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
// Steps converge quadratically, or by a factor of two where the triangles pass each other just within the clearance.
constexpr int kMostSteps = 200;
// Of a rate: of two unit vectors and their inner product.
constexpr double kRateError = 64 * kUnit;

Vector operator+(const Vector& p, const Vector& q) {
  return {p[0] + q[0], p[1] + q[1], p[2] + q[2]};
}
Vector operator-(const Vector& p, const Vector& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}
Vector operator*(double f, const Vector& v) {
  return {f * v[0], f * v[1], f * v[2]};
}
Vector crossProduct(const Vector& p, const Vector& q) {
  return {p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]};
}
double norm1(const Vector& v) {
  return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
}

/// The nearest pair of points found so far.
struct Nearest {
  Vector a{}, b{};
  exact::Features features{Feature::vertex, Feature::vertex};
  double squared = kInfinity;

  void offer(const Vector& p, const Vector& q, const exact::Features& on) {
    const Vector gap = q - p;
    if (const double d = dot(gap, gap); d < squared) *this = {p, q, on, d};
  }
};

/// The feature on which the point at a share of an edge is.
Feature featureAt(double share) {
  return share > 0 && share < 1 ? Feature::edge : Feature::vertex;
}

// The points need not be the nearest: any will do for the bounds, but these make them tight. Cross products lose far
// fewer digits than the squares of a Gram matrix if a triangle is a needle.

void offerEdges(Nearest& nearest, const Vector& a0, const Vector& a1, const Vector& b0, const Vector& b1) {
  const Vector x = a1 - a0, y = b1 - b0, r = b0 - a0, n = crossProduct(x, y);
  const double nn = dot(n, n), xx = dot(x, x), yy = dot(y, y);
  double s = nn > 0 ? std::clamp(dot(crossProduct(r, y), n) / nn, 0.0, 1.0) : 0;
  double t = yy > 0 ? std::clamp(dot(a0 + s * x - b0, y) / yy, 0.0, 1.0) : 0;
  s = xx > 0 ? std::clamp(dot(b0 + t * y - a0, x) / xx, 0.0, 1.0) : 0;
  t = yy > 0 ? std::clamp(dot(a0 + s * x - b0, y) / yy, 0.0, 1.0) : 0;
  nearest.offer(a0 + s * x, b0 + t * y, {featureAt(s), featureAt(t)});
}

/// The point of a face at `p`, as seen along its normal; none if it is outside.
std::optional<Vector> onFace(const Vector& p, const exact::Triangle& face) {
  const Vector x = face[1] - face[0], y = face[2] - face[0], r = p - face[0], n = crossProduct(x, y);
  const double nn = dot(n, n);
  if (!(nn > 0)) return std::nullopt;
  const double v = dot(crossProduct(r, y), n) / nn, w = dot(crossProduct(x, r), n) / nn;
  if (!(v >= 0 && w >= 0 && v + w <= 1)) return std::nullopt;
  return face[0] + v * x + w * y;
}

/// Where an edge crosses a face: the points of both, which rounding may keep apart.
struct Crossing {
  Vector onEdge, onFace;
};
std::optional<Crossing> crossing(const Vector& p, const Vector& q, const exact::Triangle& face) {
  const Vector n = crossProduct(face[1] - face[0], face[2] - face[0]);
  const double before = dot(n, p - face[0]), after = dot(n, q - face[0]);
  if (!(before * after < 0)) return std::nullopt;
  const Vector at = p + std::clamp(before / (before - after), 0.0, 1.0) * (q - p);
  const auto above = onFace(at, face);
  return above ? std::optional(Crossing{at, *above}) : std::nullopt;
}

Nearest nearestPoints(const exact::Triangle& a, const exact::Triangle& b) {
  Nearest nearest{a[0], b[0]};
  for (size_t i = 0; i < 3; ++i) {
    for (size_t k = 0; k < 3; ++k) offerEdges(nearest, a[i], a[(i + 1) % 3], b[k], b[(k + 1) % 3]);
    if (const auto p = onFace(a[i], b)) nearest.offer(a[i], *p, {Feature::vertex, Feature::face});
    if (const auto p = onFace(b[i], a)) nearest.offer(*p, b[i], {Feature::face, Feature::vertex});
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
struct Moment {
  Nearest nearest;     // relative to corner 0 of the moving triangle
  double least, most;  // bounds on their distance
  double rate;         // of a bound that `least` gives on all distances: the decrease per unit of motion
  double error;        // of positions
};

Moment momentAt(const exact::Triangle& edges, const exact::Triangle& gaps, const Vector& unit, double t) {
  exact::Triangle b;
  for (size_t k = 0; k < 3; ++k) b[k] = gaps[k] - t * unit;
  Moment m{.nearest = nearestPoints(edges, b)};
  // Differences, the motion and its direction lose less than 16u of these numbers; the nearest points, whatever their
  // weights, and inner products with a unit vector less than 16u more.
  double size = t;
  for (size_t k = 0; k < 3; ++k) size = std::max({size, norm1(gaps[k]), norm1(b[k]), norm1(edges[k])});
  m.error = 64 * kUnit * size + std::numeric_limits<double>::min();
  const Vector gap = m.nearest.b - m.nearest.a;
  const double length = std::sqrt(dot(gap, gap));
  m.most = length + m.error;
  m.least = 0;
  m.rate = 1;
  if (!(length > 0 && std::isfinite(length))) return m;
  // A plane across the line between the nearest points keeps the triangles apart, now and until the motion has used up
  // its distance.
  const Vector n = (1 / length) * gap;
  const double from = std::max({dot(n, edges[0]), dot(n, edges[1]), dot(n, edges[2])});
  const double to = std::min({dot(n, b[0]), dot(n, b[1]), dot(n, b[2])});
  m.least = std::max(to - from - m.error, 0.0);
  m.rate = dot(n, unit);
  return m;
}

/// Sets point, relative to corner 0 of the moving triangle, and normal.
void describe(Approach& found, const Moment& m) {
  found.point = m.nearest.b;
  found.features = m.nearest.features;
  const Vector gap = m.nearest.a - m.nearest.b;
  if (m.least > 0) found.normal = (1 / std::sqrt(dot(gap, gap))) * gap;
}

/// Scales back. `corner`: corner 0 of the moving triangle, at the start.
Approach inWorld(Approach found, const Vector& corner, const Vector& unit, double unscale) {
  found.lo *= unscale;
  found.hi *= unscale;
  found.point = corner + found.lo * unit + unscale * found.point;
  return found;
}

}  // namespace

std::optional<Approach> approach(const exact::Triangle& a, const exact::Triangle& b, const Vector& unit,
                                 double givenClearance, double givenDistance, double givenTolerance) {
  exact::Triangle edges, gaps;
  double size = givenClearance;
  for (size_t i = 0; i < 3; ++i) {
    edges[i] = a[i] - a[0];
    gaps[i] = b[i] - a[0];
    size = std::max({size, norm1(edges[i]), norm1(gaps[i])});
  }
  // Scaled by a power of two to about 1, so that products neither overflow nor underflow.
  const int exponent = std::clamp(std::ilogb(size), -1000, 1000);
  const double scale = std::ldexp(1.0, -exponent), unscale = std::ldexp(1.0, exponent);
  for (size_t i = 0; i < 3; ++i) {
    edges[i] = scale * edges[i];
    gaps[i] = scale * gaps[i];
  }
  const double clearance = scale * givenClearance, distance = scale * givenDistance, tolerance = scale * givenTolerance;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  Approach found{0, kInfinity, {kNan, kNan, kNan}, {kNan, kNan, kNan}, {}};
  // The distance is convex in t. So contact fills one interval, which lies between found.lo and `end`.
  double t = 0, end = kInfinity, step = 0, approaching = 0, receding = kInfinity;
  for (int i = 0; i < kMostSteps; ++i) {
    const Moment m = momentAt(edges, gaps, unit, t);
    const double least = std::max(0.5 * tolerance, 4 * m.error);
    if (m.most <= clearance) {
      found.hi = t;
      describe(found, t == 0 ? m : momentAt(edges, gaps, unit, found.lo));
      return inWorld(found, a[0], unit, unscale);
    }
    if (m.least > clearance) {
      // No contact while the plane, which moves at a constant rate, is farther than the clearance.
      const double spare = (m.least - clearance) * (1 - 16 * kUnit), forward = m.rate + kRateError,
                   backward = kRateError - m.rate;
      const double from = backward > 0 ? t - spare / backward : -kInfinity;
      const double to = forward > 0 ? t + spare / forward : kInfinity;
      if (from <= found.lo) {
        found.lo = std::max(found.lo, to * (1 - 4 * kUnit));
      } else if (to >= end || std::isinf(to)) {
        end = std::min(end, from * (1 + 4 * kUnit));
      } else {
        return inWorld(found, a[0], unit, unscale);
      }
      if (found.lo > distance || found.lo >= end) return std::nullopt;
      step = least;
      const double next = std::min({found.lo + step, 0.5 * found.lo + 0.5 * end, distance});
      // A motion along the plane leaves no room for another step.
      if (next == t) return inWorld(found, a[0], unit, unscale);
      t = next;
    } else {
      // Rounding leaves open whether the triangles are within the clearance now. They are nearest to each other between
      // where they still approach and where they move apart.
      const bool isApproaching = m.rate + kRateError > 0;
      if (isApproaching) approaching = std::max(approaching, t);
      if (!isApproaching) receding = std::min(receding, t);
      const double from = std::max(found.lo, approaching), to = std::min(end, receding);
      step = std::max(2 * step, least);
      const double next = isApproaching ? std::min({t + step, 0.5 * t + 0.5 * to, distance}) : 0.5 * from + 0.5 * t;
      if (next == t || !(to - from > m.error)) return inWorld(found, a[0], unit, unscale);
      t = next;
    }
  }
  return inWorld(found, a[0], unit, unscale);
}

}  // namespace radar::cpu
