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
/// Edge i of a and edge k of b are place 3 i + k, corner i of a over the face of b 9 + i, corner i of b over that of a
/// 12 + i.
using FeaturePlace = uint32_t;
inline constexpr FeaturePlace kAnyPlace = 15;

/// The nearest pair of points found so far.
template <class Real>
struct Nearest {
  Point<Real> a{}, b{};
  Features features{Feature::vertex, Feature::vertex};
  size_t corner = 0;    ///< of b, if that is a vertex
  Real squared{1e300};  // infinity would not survive sums of double-doubles
  FeaturePlace place = kAnyPlace;

  /// Returns whether the points are nearer.
  bool offer(const Point<Real>& p, const Point<Real>& q, const Features& on, size_t cornerOfB, FeaturePlace at) {
    const Point<Real> gap = q - p;
    const Real d = dot(gap, gap);
    const bool isNearer = d < squared;
    if (isNearer) *this = {p, q, on, cornerOfB, d, at};
    return isNearer;
  }

  /// Whether planes across the gap, through its ends, part the triangles, but for a distance of `off`. Then no points
  /// of them are nearer by more.
  bool parts(const Corners<Real>& ofA, const Corners<Real>& ofB, const Real& off) const {
    const Point<Real> gap = b - a;
    const Real beyond = std::max({dot(gap, ofA[0] - a), dot(gap, ofA[1] - a), dot(gap, ofA[2] - a)}) -
                        std::min({dot(gap, ofB[0] - b), dot(gap, ofB[1] - b), dot(gap, ofB[2] - b)});
    return squared > off * off && (!(beyond > Real{}) || beyond * beyond < off * off * squared);
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

/// Returns whether points of edge i of a and edge k of b are nearer.
template <class Real>
bool offerEdges(Nearest<Real>& nearest, const Corners<Real>& a, size_t i, const Corners<Real>& b, size_t k) {
  const size_t end = (k + 1) % 3;
  const Point<Real>&a0 = a[i], &b0 = b[k];
  const Point<Real> x = a[(i + 1) % 3] - a0, y = b[end] - b0, r = b0 - a0, n = crossProduct(x, y);
  const Real nn = dot(n, n), xx = dot(x, x), yy = dot(y, y);
  Real s = share(dot(crossProduct(r, y), n), nn);
  Real t = share(dot(a0 + s * x - b0, y), yy);
  s = share(dot(b0 + t * y - a0, x), xx);
  t = share(dot(a0 + s * x - b0, y), yy);
  return nearest.offer(a0 + s * x, b0 + t * y, {featureAt(s), featureAt(t)}, t > Real{} ? end : k,
                       static_cast<FeaturePlace>(3 * i + k));
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

/// Returns whether the points at a place are nearer.
template <class Real>
bool offerAt(Nearest<Real>& nearest, FeaturePlace place, const Corners<Real>& a, const Corners<Real>& b) {
  if (place < 9) return offerEdges(nearest, a, place / 3, b, place % 3);
  const size_t i = place % 3;
  if (place < 12) {
    const auto p = onFace(a[i], b);
    return p && nearest.offer(a[i], *p, {Feature::vertex, Feature::face}, 0, place);
  }
  const auto p = onFace(b[i], a);
  return p && nearest.offer(*p, b[i], {Feature::face, Feature::vertex}, i, place);
}

/// Of a point or a segment, the others repeat these.
template <class Real>
unsigned distinctEdges(const Corners<Real>& t) {
  if (t[0] == t[1]) return t[1] == t[2] ? 0b001 : 0b010;
  return t[1] == t[2] || t[2] == t[0] ? 0b001 : 0b111;
}

/// The edges that face each other, as far as the triangles' middles tell.
template <class Real>
FeaturePlace facingEdges(const Corners<Real>& a, const Corners<Real>& b) {
  const Point<Real> way = b[0] + b[1] + b[2] - (a[0] + a[1] + a[2]);
  const auto opposite = [&](const Corners<Real>& t, bool isLess) {
    const Real at[3] = {dot(way, t[0]), dot(way, t[1]), dot(way, t[2])};
    uint32_t out = 0;
    for (uint32_t i = 1; i < 3; ++i) {
      if (isLess ? at[i] < at[out] : at[out] < at[i]) out = i;
    }
    return (out + 1) % 3;
  };
  return 3 * opposite(a, true) + opposite(b, false);
}

/// No points of the triangles are nearer by more than `enough`, but for rounding. `first`: where they may be.
template <class Real>
Nearest<Real> nearestPoints(const Corners<Real>& a, const Corners<Real>& b, const Real& enough = {},
                            FeaturePlace first = kAnyPlace) {
  Nearest<Real> nearest{a[0], b[0]};
  if (first == kAnyPlace) first = facingEdges(a, b);
  if (offerAt(nearest, first, a, b) && nearest.parts(a, b, enough)) return nearest;
  const unsigned edgesA = distinctEdges(a), edgesB = distinctEdges(b);
  for (FeaturePlace place = 0; place < kAnyPlace; ++place) {
    const bool isRepeated =
        place == first || (place < 9 && ((edgesA >> place / 3 & 1) == 0 || (edgesB >> place % 3 & 1) == 0));
    if (!isRepeated && offerAt(nearest, place, a, b) && nearest.parts(a, b, enough)) return nearest;
  }
  for (size_t i = 0; i < 3; ++i) {
    if (const auto at = crossing(a[i], a[(i + 1) % 3], b)) {
      nearest.offer(at->onEdge, at->onFace, {Feature::edge, Feature::face}, 0, kAnyPlace);
    }
    if (const auto at = crossing(b[i], b[(i + 1) % 3], a)) {
      nearest.offer(at->onFace, at->onEdge, {Feature::face, Feature::edge}, 0, kAnyPlace);
    }
  }
  return nearest;
}

}  // namespace radar::exact
