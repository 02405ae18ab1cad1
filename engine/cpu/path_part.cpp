#include "cpu/path_part.h"

#include <algorithm>
#include <cmath>

#include "cpu/node_test.h"

namespace radar::cpu {

double bendAllowed(const Mesh& mesh, const Transform& pose, double radius) {
  constexpr double kBend = 0.05, kBendOfEdge = 0.5, kLeast = 0x1p-10;  // of the radius, of an edge
  double longest = 0;                                                  // of the axes' images
  for (int k = 0; k < 3; ++k) longest = std::max(longest, norm({pose.m[k], pose.m[4 + k], pose.m[8 + k]}));
  return std::max(std::min(kBend * radius, kBendOfEdge * longest * mesh.meanEdge), kLeast * radius);
}

PathPart::PathPart(const Mesh& mesh, const End& first, const End& last, double bending, double rounding)
    : from(first.s),
      end(last.s),
      at{{mesh, first.pose}, {mesh, last.pose}},
      axes{MeshAxes(at[0].linear), MeshAxes(at[1].linear)},
      bend(bending),
      error(rounding),
      start(boxOf(mesh, first.pose.m)) {
  const Vector moved = minus(last.middle, first.middle);
  Box other = boxOf(mesh, last.pose.m);
  for (int k = 0; k < 3; ++k) {
    other.lo[k] -= moved[k];
    other.hi[k] -= moved[k];
  }
  start.merge(other);
  for (int k = 0; k < 3; ++k) {
    const double off = 16 * kUnit * (std::abs(moved[k]) + std::abs(first.middle[k]) + std::abs(last.middle[k]));
    start.lo[k] -= off;
    start.hi[k] += off;
  }
  const double straight = norm(moved);
  // Along another unit vector, at most as far as the middle moves.
  piece.unit = straight > 0x1p-500 ? scaled(1 / straight, moved) : Vector{1, 0, 0};
  piece.from = from;
  piece.end = end;
  piece.rate = (1 + 0x1p-40) * straight / (end - from) + 0x1p-1000;
  piece.deviation = (1 + 0x1p-40) * (2 * bend + 2 * error) + 0x1p-40 * straight + 0x1p-490;
}

PathPlacement::PathPlacement(const Frame& frame) {
  for (int k = 0; k < 3; ++k) {
    slack[k] = 0;
    double magnitude = 4;
    for (int e = 0; e < 2; ++e) {
      const Vector& n = frame.axes[e]->rows[k];
      const MeshPlacement &own = *frame.own[e], &other = *frame.other[e];
      offset[e][k] = dot(n, frame.gap[e]);
      magnitude += std::abs(offset[e][k]);
      Vector rounding;
      for (int i = 0; i < 3; ++i) {
        rounding[i] = own.error[i] + other.error[i] + 0x1p-1000 +
                      32 * kUnit * (own.extent[i] + other.extent[i] + std::abs(frame.gap[e][i]));
      }
      for (int j = 0; j < 3; ++j) {
        matrix[e][k][j] = n[0] * other.linear[0][j] + n[1] * other.linear[1][j] + n[2] * other.linear[2][j];
        magnitude += 2 * std::abs(matrix[e][k][j]);
      }
      const double across = frame.axis == Vector{} ? norm(n) : norm(cross(frame.axis, n)) + 0x1p-40 * norm(n);
      const double bent = across * frame.bend;
      slack[k] = std::max(
          slack[k], 1.01 * (norm(n) * frame.apart + bent) + reachAlong(n, rounding) + 2 * frame.axes[e]->residual[k]);
    }
    slack[k] += 64 * kUnit * magnitude;
    if (!(magnitude < kMostMagnitude<double>)) slack[k] = INFINITY;
  }
}

}  // namespace radar::cpu
