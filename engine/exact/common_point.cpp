#include "exact/common_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace radar::exact {

namespace {

using Point = Eigen::Vector3d;

struct Candidate {
  double inside;  ///< least barycentric coordinate in the pierced triangle
  Point at;
};

Point point(const Vec& v) {
  return {v[0], v[1], v[2]};
}

/// All of `face` and `other` is relative to a corner of `face`.
void pierce(const std::array<Point, 3>& face, const std::array<Point, 3>& other, Candidate& best) {
  const Point normal = (face[1] - face[0]).cross(face[2] - face[0]);
  const double square = normal.squaredNorm();
  if (square == 0) return;
  for (int i = 0; i < 3; ++i) {
    const Point &p = other[i], &q = other[(i + 1) % 3];
    const double above = normal.dot(p - face[0]), below = normal.dot(q - face[0]);
    if ((above > 0) == (below > 0) && above != 0 && below != 0) continue;
    if (above == below) continue;
    const Point at = p + above / (above - below) * (q - p);
    double inside = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const Point &r = face[k], &s = face[(k + 1) % 3];
      inside = std::min(inside, normal.dot((s - r).cross(at - r)) / square);
    }
    if (inside > best.inside) best = {inside, at};
  }
}

}  // namespace

Vec commonPoint(const Triangle& a, const Triangle& b) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Point origin = point(b[0]);
  std::array<Point, 3> pa, pb;
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    pa[i] = point(a[i]) - origin;
    pb[i] = point(b[i]) - origin;
    size = std::max({size, pa[i].cwiseAbs().maxCoeff(), pb[i].cwiseAbs().maxCoeff()});
  }
  // Of unit size, so that products neither under- nor overflow.
  for (int i = 0; i < 3; ++i) {
    pa[i] /= size;
    pb[i] /= size;
  }
  Candidate best{-1e-9, {kNaN, kNaN, kNaN}};
  pierce(pb, pa, best);
  pierce(pa, pb, best);
  best.at = best.at * size + origin;
  return {best.at[0], best.at[1], best.at[2]};
}

}  // namespace radar::exact
