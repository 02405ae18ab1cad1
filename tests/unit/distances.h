// Distances of triangles, one of them in motion, in numbers of any precision: another method than the engine's.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <cmath>
#include <limits>

#include "exact_oracle.h"

namespace distances {

template <class Real>
using Point = Eigen::Matrix<Real, 3, 1>;
template <class Real>
using Points = std::array<Point<Real>, 3>;

template <class Real>
Point<Real> pointOf(const std::array<double, 3>& p) {
  return {Real(p[0]), Real(p[1]), Real(p[2])};
}
template <class Real>
Points<Real> pointsOf(const std::array<std::array<double, 3>, 3>& triangle) {
  return {pointOf<Real>(triangle[0]), pointOf<Real>(triangle[1]), pointOf<Real>(triangle[2])};
}

/// Above every distance.
template <class Real>
const Real kFar = Real(1e300);

/// The shortest way from a point to a segment; from a line to another one, if it begins and ends within both segments;
/// from a point to a face above which it is. kFar along each axis if there is none.
template <class Real>
Point<Real> toSegment(const Point<Real>& p, const Point<Real>& from, const Point<Real>& to) {
  const Point<Real> way = to - from;
  const Real square = way.dot(way), share = square > 0 ? Real((p - from).dot(way) / square) : Real(0);
  const Real at = share < 0 ? Real(0) : share > 1 ? Real(1) : share;
  return from + at * way - p;
}
template <class Real>
Point<Real> acrossLines(const Point<Real>& a0, const Point<Real>& a1, const Point<Real>& b0, const Point<Real>& b1) {
  const Point<Real> x = a1 - a0, y = b1 - b0, r = b0 - a0, n = x.cross(y);
  const Real nn = n.dot(n), parallel = 1000 * std::numeric_limits<Real>::epsilon();
  if (nn <= parallel * parallel * x.squaredNorm() * y.squaredNorm()) return Point<Real>::Constant(kFar<Real>);
  const Real s = r.cross(y).dot(n), t = r.cross(x).dot(n);
  if (s < 0 || s > nn || t < 0 || t > nn) return Point<Real>::Constant(kFar<Real>);
  return Real(r.dot(n) / nn) * n;
}
template <class Real>
Point<Real> toFace(const Point<Real>& p, const Points<Real>& face) {
  const Point<Real> x = face[1] - face[0], y = face[2] - face[0], r = p - face[0], n = x.cross(y);
  const Real nn = n.dot(n);
  const Real v = r.cross(y).dot(n), w = x.cross(r).dot(n);
  if (nn == 0 || v < 0 || w < 0 || v + w > nn) return Point<Real>::Constant(kFar<Real>);
  return Real(-r.dot(n) / nn) * n;
}
/// Distance of a point and a triangle, also a degenerate one.
template <class Real>
Real fromTriangle(const Point<Real>& p, const Points<Real>& t) {
  return std::min({toFace(p, t).norm(), toSegment(p, t[0], t[1]).norm(), toSegment(p, t[1], t[2]).norm(),
                   toSegment(p, t[2], t[0]).norm()});
}
template <class Real>
bool crosses(const Point<Real>& p, const Point<Real>& q, const Points<Real>& face) {
  const Point<Real> n = (face[1] - face[0]).cross(face[2] - face[0]);
  const Real before = n.dot(p - face[0]), after = n.dot(q - face[0]);
  return before * after < 0 && toFace<Real>(p + Real(before / (before - after)) * (q - p), face)[0] < kFar<Real>;
}

/// The shortest way from a triangle to another one, 0 if they meet.
template <class Real>
Point<Real> gap(const Points<Real>& a, const Points<Real>& b) {
  Point<Real> shortest = Point<Real>::Constant(kFar<Real>);
  Real least = kFar<Real> * kFar<Real>;
  const auto offer = [&](const Point<Real>& way) {
    const Real square = way.squaredNorm();
    if (!(square < least)) return;
    least = square;
    shortest = way;
  };
  for (size_t i = 0; i < 3; ++i) {
    const Point<Real>&a0 = a[i], &a1 = a[(i + 1) % 3], &b0 = b[i], &b1 = b[(i + 1) % 3];
    if (crosses(a0, a1, b) || crosses(b0, b1, a)) return Point<Real>::Zero();
    offer(toFace(a0, b));
    offer(-toFace(b0, a));
    for (size_t k = 0; k < 3; ++k) {
      offer(toSegment(a0, b[k], b[(k + 1) % 3]));
      offer(-toSegment(b0, a[k], a[(k + 1) % 3]));
      offer(acrossLines(a0, a1, b[k], b[(k + 1) % 3]));
    }
  }
  return shortest;
}
template <class Real>
Real distance(const Points<Real>& a, const Points<Real>& b) {
  return gap(a, b).norm();
}

template <class Real>
Point<Real> gapAt(const Points<Real>& a, const Points<Real>& b, const Point<Real>& unit, const Real& t) {
  Points<Real> moved;
  for (size_t i = 0; i < 3; ++i) moved[i] = a[i] + t * unit;
  return gap(moved, b);
}
template <class Real>
Real distanceAt(const Points<Real>& a, const Points<Real>& b, const Point<Real>& unit, const Real& t) {
  return gapAt(a, b, unit, t).norm();
}

/// The least distance for 0 <= t <= end: it is convex in t.
template <class Real>
Real leastDistance(const Points<Real>& a, const Points<Real>& b, const Point<Real>& unit, const Real& end, int steps) {
  Real from = 0, to = end;
  for (int i = 0; i < steps; ++i) {
    const Real p = from + Real(0.382) * (to - from), q = from + Real(0.618) * (to - from);
    if (distanceAt(a, b, unit, p) < distanceAt(a, b, unit, q)) {
      to = q;
    } else {
      from = p;
    }
  }
  return distanceAt(a, b, unit, Real(0.5 * (from + to)));
}

/// How far the point of an answer is from the farther of its two triangles at the moment of contact, as a share of the
/// greatest coordinate or way.
inline double offFromBoth(const radar::Scene& scene, const radar::Query& query, const radar::Result& result) {
  using Real = boost::multiprecision::cpp_bin_float_quad;
  const radar::Object& object = scene.object(result.object);
  Points<Real> a = pointsOf<Real>(oracle::corners(scene.mesh(query.mesh), query.worldFromMesh, result.triA)),
               b = pointsOf<Real>(oracle::corners(scene.mesh(object.mesh), object.worldFromMesh, result.triB));
  const Point<Real> unit = pointOf<Real>(query.direction).normalized(),
                    way = Real(result.t) * (query.motion ? pointOf<Real>(*query.motion) : unit),
                    itsWay = Real(result.fraction) * pointOf<Real>(object.motion);
  Real size = 0;
  for (size_t i = 0; i < 3; ++i) {
    a[i] += way;
    b[i] += itsWay;
    for (const Point<Real>& p : {a[i], b[i], way}) size = std::max(size, p.cwiseAbs().maxCoeff());
  }
  for (Point<Real>* p : {&a[0], &a[1], &a[2], &b[0], &b[1], &b[2]}) *p /= size;
  const Point<Real> point = pointOf<Real>(result.point) / size;
  return static_cast<double>(std::max(fromTriangle(point, a), fromTriangle(point, b)));
}

}  // namespace distances
