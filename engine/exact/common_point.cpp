#include "exact/common_point.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exact/determinant.h"
#include "exact/nearest_points.h"

namespace radar::exact {

namespace {

struct Candidate {
  double inside;  ///< least barycentric coordinate in the pierced triangle
  Vector at;
};

using radar::cross, radar::dot;

/// Considers the crossings of the edges of `other` with `face`.
void pierce(const Triangle& face, const Triangle& other, Candidate& best) {
  const Vector normal = cross(minus(face[1], face[0]), minus(face[2], face[0]));
  const double square = dot(normal, normal);
  if (square == 0) return;
  for (int i = 0; i < 3; ++i) {
    const Vector &p = other[i], &q = other[(i + 1) % 3];
    const double above = dot(normal, minus(p, face[0])), below = dot(normal, minus(q, face[0]));
    if ((above > 0) == (below > 0) && above != 0 && below != 0) continue;
    if (above == below) continue;
    const double share = above / (above - below);
    const Vector at = along(p, share, minus(q, p));
    double inside = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 3; ++k) {
      const Vector &r = face[k], &s = face[(k + 1) % 3];
      inside = std::min(inside, dot(normal, cross(minus(s, r), minus(at, r))) / square);
    }
    if (inside > best.inside) best = {inside, at};
  }
}

/// How exact arithmetic has the first crossing of an edge of `other` with `face`.
std::optional<Vector> exactCrossing(const Triangle& face, const Triangle& other) {
  const Difference x{face[0], face[1]}, y{face[0], face[2]};
  for (int i = 0; i < 3; ++i) {
    const Vector &p = other[i], &q = other[(i + 1) % 3];
    const Determinant above{{face[0], p}, x, y}, below{{face[0], q}, x, y};
    if (sign(above) * sign(below) > 0 || (sign(above) == 0 && sign(below) == 0)) continue;
    int least = 1, greatest = -1;
    for (int k = 0; k < 3; ++k) {
      const int side = sign(Determinant{{p, q}, {p, face[k]}, {p, face[(k + 1) % 3]}});
      least = std::min(least, side);
      greatest = std::max(greatest, side);
    }
    if (least < 0 && greatest > 0) continue;
    const Dyadic height = exactly(above);
    const double share = quotient(height, height - exactly(below));
    return along(p, share, minus(q, p));
  }
  return std::nullopt;
}

}  // namespace

Vector commonPoint(const Triangle& first, const Triangle& second) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  Triangle a = first, b = second;
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  const Vector origin = b[0];
  Triangle pa, pb;
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    pa[i] = minus(a[i], origin);
    pb[i] = minus(b[i], origin);
    for (int k = 0; k < 3; ++k) size = std::max({size, std::abs(pa[i][k]), std::abs(pb[i][k])});
  }
  // Scaled to unit size, so that products neither underflow nor overflow.
  for (Triangle* t : {&pa, &pb}) {
    for (Vector& p : *t) {
      for (double& c : p) c /= size;
    }
  }
  Candidate best{-1, {kNaN, kNaN, kNaN}};
  pierce(pb, pa, best);
  pierce(pa, pb, best);
  // Where triangles cross by little more than rounding errors, the crossing may seem to be outside.
  if (!(best.inside >= 0)) {
    const std::optional<Vector> ofA = exactCrossing(b, a), crossing = ofA ? ofA : exactCrossing(a, b);
    if (crossing) return withoutZeroSigns(*crossing);
    // In one plane, or degenerate: they touch where they are nearest to each other.
    best.at = nearestPoints<double>(pa, pb).b;
  }
  for (int k = 0; k < 3; ++k) best.at[k] = best.at[k] * size + origin[k];
  return withoutZeroSigns(best.at);
}

}  // namespace radar::exact
