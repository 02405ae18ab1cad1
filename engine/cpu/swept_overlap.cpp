#include "cpu/swept_overlap.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

// Between these limits, overflow and underflow of products of three factors do not affect the result.
constexpr double kMostError = 0x1p200, kLeastWidth = 0x1p-250;
constexpr int kNext[3] = {1, 2, 0};

/// The pair seen along the motion: orientations of each edge of one with each vertex of the other, [edge][vertex].
struct Outlines {
  double overA[3][3], overB[3][3];
  double bound;  ///< bound on the error of each orientation
};

double most(const double (&v)[3]) {
  return std::max(std::max(v[0], v[1]), v[2]);
}

double least(const double (&v)[3]) {
  return std::min(std::min(v[0], v[1]), v[2]);
}

/// Whether an edge certainly separates the triangles. `over`: its orientations with the other triangle's vertices.
/// `area`: the signed area of its own triangle, within `areaError`.
bool separates(const double (&over)[3], double bound, double area, double areaError) {
  return (area > areaError && most(over) < -bound) || (area < -areaError && least(over) > bound);
}

/// Computes the orientations; false if an edge separates the pair. `width`: bound on the differences across the motion.
bool outline(const ViewedTriangle& a, const ViewedTriangle& b, double width, Outlines& out) {
  const double error = a.error + b.error + kUnit * width;
  out.bound = 4 * width * error + 4 * error * error + 4 * kUnit * width * width;
  double x[3][3], y[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      x[i][k] = b.corners[k][0] - a.corners[i][0];
      y[i][k] = b.corners[k][1] - a.corners[i][1];
    }
  }
  for (int i = 0; i < 3; ++i) {
    const int j = kNext[i];
    for (int k = 0; k < 3; ++k) out.overA[i][k] = x[i][k] * y[j][k] - y[i][k] * x[j][k];
    if (separates(out.overA[i], out.bound, a.area, a.areaError)) return false;
  }
  for (int k = 0; k < 3; ++k) {
    const int l = kNext[k];
    for (int i = 0; i < 3; ++i) out.overB[k][i] = x[i][k] * y[i][l] - y[i][k] * x[i][l];
    if (separates(out.overB[k], out.bound, b.area, b.areaError)) return false;
  }
  return true;
}

/// Bounds on the interval of contact, from all events that are not certainly impossible.
struct ContactTimes {
  double first = INFINITY, last = -INFINITY;

  void add(double t, double wide) {
    if (wide < INFINITY) {
      first = std::min(first, t - wide);
      last = std::max(last, t + wide);
    } else {  // edge-on, or nearly parallel edges
      first = -INFINITY;
      last = INFINITY;
    }
  }
};

/// Adds the event of a vertex at `height` on a face: t = `turn` * (depth of the face there - height). p, q, r are the
/// vertex's orientations with the face's edges; they weight the opposite corners, whose depths are zp, zq, zr.
void addCorner(ContactTimes& span, double bound, double error, double turn, double height, double p, double q, double r,
               double zp, double zq, double zr, double range) {
  if (!((p >= -bound && q >= -bound && r >= -bound) || (p <= bound && q <= bound && r <= bound))) return;
  const double sum = p + q + r, z = (p * zp + q * zq + r * zr) / sum;
  span.add(turn * (z - height), 8 * bound * range / std::abs(sum) + error);
}

bool sameSide(double p, double q, double bound) {
  return (p > bound && q > bound) || (p < -bound && q < -bound);
}

ContactTimes spanOf(const ViewedTriangle& a, const ViewedTriangle& b, const Outlines& seen) {
  ContactTimes span;
  const double bound = seen.bound, error = 2 * (a.error + b.error);
  const double rangeA = a.hi[2] - a.lo[2], rangeB = b.hi[2] - b.lo[2];
  double za[3], zb[3];
  for (int i = 0; i < 3; ++i) {
    za[i] = a.corners[i][2];
    zb[i] = b.corners[i][2];
  }
  for (int i = 0; i < 3; ++i) {
    const int j = kNext[i];
    addCorner(span, bound, error, 1, za[i], seen.overB[1][i], seen.overB[2][i], seen.overB[0][i], zb[0], zb[1], zb[2],
              rangeB);
    addCorner(span, bound, error, -1, zb[i], seen.overA[1][i], seen.overA[2][i], seen.overA[0][i], za[0], za[1], za[2],
              rangeA);
    for (int k = 0; k < 3; ++k) {
      const int l = kNext[k];
      const double p = seen.overA[i][k], q = seen.overA[i][l], r = seen.overB[k][i], s = seen.overB[k][j];
      if (sameSide(p, q, bound) || sameSide(r, s, bound)) continue;
      const double depthB = (q * zb[k] - p * zb[l]) / (q - p), depthA = (s * za[i] - r * za[j]) / (s - r);
      span.add(depthB - depthA, 6 * bound * (rangeA / std::abs(s - r) + rangeB / std::abs(q - p)) + error);
    }
  }
  return span;
}

}  // namespace

// The bounds are derived in docs/exact.md.
Meeting meetingOf(const ViewedTriangle& a, const ViewedTriangle& b, double latest) {
  // Also if the error is NaN.
  if (!(a.error + b.error < kMostError)) return Meeting::unknown;
  Vector below, above;  // bounds on differences b - a
  for (int k = 0; k < 3; ++k) {
    below[k] = b.lo[k] - a.hi[k];
    above[k] = b.hi[k] - a.lo[k];
  }
  const double width = std::max({above[0], -below[0], above[1], -below[1]});
  if (width < kLeastWidth) return Meeting::unknown;
  if (below[0] > 0 || below[1] > 0 || above[0] < 0 || above[1] < 0) return Meeting::never;
  if (below[2] > latest || above[2] < 0) return Meeting::never;
  Outlines seen;
  if (!outline(a, b, width, seen)) return Meeting::never;
  const ContactTimes span = spanOf(a, b, seen);
  if (span.first > latest || span.last < 0) return Meeting::never;
  return span.first > 0 ? Meeting::ahead : Meeting::unknown;
}

}  // namespace radar::cpu
