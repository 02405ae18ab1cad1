// The nearest points of two triangles, rounded; written once for doubles and for double-doubles.
#pragma once

#include <algorithm>
#include <optional>

#include "exact/contact.h"

namespace radar::exact {

// Points are differences from a point near both triangles, on a scale on which nothing over- or underflows.

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
/// The nearest pair of points found so far.
template <class Real>
struct Nearest {
  Point<Real> a{}, b{};
  Features features{Feature::vertex, Feature::vertex};
  size_t corner = 0;    ///< of b, if that is a vertex
  Real squared{1e300};  // infinity would not survive sums of double-doubles

  void offer(const Point<Real>& p, const Point<Real>& q, const Features& on, size_t cornerOfB = 0) {
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

}  // namespace radar::exact
