#include "cpu/pair_motion.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace radar::cpu {

namespace {

/// A power of two that scales `x` to about 1; 0 and subnormals stay small.
double scaleOf(double x) {
  const uint64_t exponent = std::bit_cast<uint64_t>(x) >> 52 & 0x7ff;
  return std::bit_cast<double>((exponent < 2045 ? 2046 - exponent : 1) << 52);
}

/// The inverse, except for rounding; not finite if it is out of range.
Matrix3 roughInverse(Matrix3 m) {
  // Columns are scaled to about 1, so that their products neither underflow nor overflow.
  Vector scale;
  for (int k = 0; k < 3; ++k) {
    scale[k] = scaleOf(std::max({std::abs(m[0][k]), std::abs(m[1][k]), std::abs(m[2][k])}));
    for (Vector& row : m) row[k] *= scale[k];
  }
  Matrix3 out;
  for (int k = 0; k < 3; ++k) {
    const int p = (k + 1) % 3, q = (k + 2) % 3;
    out[k] = {m[1][p] * m[2][q] - m[1][q] * m[2][p], m[2][p] * m[0][q] - m[2][q] * m[0][p],
              m[0][p] * m[1][q] - m[0][q] * m[1][p]};
  }
  const double rate = 1 / (m[0][0] * out[0][0] + m[1][0] * out[0][1] + m[2][0] * out[0][2]);
  for (int k = 0; k < 3; ++k) {
    for (double& c : out[k]) c *= scale[k] * rate;
  }
  return out;
}

}  // namespace

MeshPlacement::MeshPlacement(const Mesh& mesh, const Transform& worldFromMesh) {
  for (int i = 0; i < 3; ++i) {
    const double* row = &worldFromMesh.m[4 * i];
    double magnitude = std::abs(row[3]);
    extent[i] = 0;
    for (int k = 0; k < 3; ++k) {
      linear[i][k] = row[k] * mesh.unit;
      extent[i] += 2 * std::abs(linear[i][k]);
      magnitude += std::abs(row[k]) * (std::abs(mesh.origin[k]) + mesh.reach[k]);
    }
    origin[i] = ((row[0] * mesh.origin[0] + row[1] * mesh.origin[1]) + row[2] * mesh.origin[2]) + row[3];
    error[i] = 16 * kUnit * magnitude + 0x1p-1000;
  }
}

MeshAxes::MeshAxes(const Matrix3& linear) : rows(roughInverse(linear)) {
  for (int k = 0; k < 3; ++k) {
    const Vector& n = rows[k];
    residual[k] = 0;
    for (int j = 0; j < 3; ++j) {
      residual[k] += std::abs(n[0] * linear[0][j] + n[1] * linear[1][j] + n[2] * linear[2][j] - (j == k));
    }
  }
}

PairMotion::PairMotion(const MeshPlacement& a, const MeshPlacement& b, const Piece& p, double c, double latest)
    : piece(p), clearance(c), span(p.wayUntil(latest)) {
  const Vector& unit = piece.unit;
  int fastest = 0;
  for (int k = 0; k < 3; ++k) {
    gap[k] = a.origin[k] - b.origin[k];
    if (std::abs(unit[k]) > std::abs(unit[fastest])) fastest = k;
  }
  // Once A has passed B along this axis, they do not meet any more.
  const int f = fastest;
  const double way = std::abs(gap[f]) + a.extent[f] + b.extent[f] + a.error[f] + b.error[f] + clearance;
  if (const double passed = 1.01 * way / std::abs(unit[f]); passed < span) span = passed;
  for (int k = 0; k < 3; ++k) {
    travel[k] = span * unit[k];
    rounding[k] = a.error[k] + b.error[k] + 0x1p-1000 * (1 + span) +
                  32 * kUnit * (a.extent[k] + b.extent[k] + std::abs(gap[k]) + std::abs(travel[k]));
  }
}

RelativePlacement::RelativePlacement(const MeshAxes& own, const MeshPlacement& other, const PairMotion& motion,
                                     int side) {
  for (int k = 0; k < 3; ++k) {
    const Vector& n = own.rows[k];
    offset[k] = side * radar::dot(n, motion.gap);
    travel[k] = side * radar::dot(n, motion.travel);
    rounding[k] = reachAlong(n, motion.rounding) + 2 * own.residual[k] + 32 * kUnit;
    slack[k] = rounding[k] + (motion.clearance > 0 ? 1.01 * std::hypot(n[0], n[1], n[2]) * motion.clearance : 0);
    magnitude[k] = 2 + std::abs(offset[k]) + std::abs(travel[k]);
    for (int j = 0; j < 3; ++j) {
      matrix[k][j] = n[0] * other.linear[0][j] + n[1] * other.linear[1][j] + n[2] * other.linear[2][j];
      magnitude[k] += 2 * std::abs(matrix[k][j]);
    }
  }
}

void narrow(TimeSpan& times, const RelativePlacement& relative, const gpu::MeshNode& own, const gpu::MeshNode& other) {
  for (int k = 0; k < 3; ++k) {
    if (!(relative.magnitude[k] < 0x1p900)) continue;
    double middle = own.centre[k] - relative.offset[k];
    double half = own.halfExtent[k] + relative.slack[k] + 32 * kUnit * relative.magnitude[k];
    for (int j = 0; j < 3; ++j) {
      middle -= relative.matrix[k][j] * other.centre[j];
      half += std::abs(relative.matrix[k][j]) * other.halfExtent[j];
    }
    const double speed = std::abs(relative.travel[k]), way = relative.travel[k] < 0 ? -middle : middle;
    if (way - half > speed * times.to || way + half < speed * times.from) {
      times = {1, 0};
      return;
    }
    // The test above keeps the quotients at most 1, whatever the speed.
    if (way - half > speed * times.from) times.from = (way - half) / speed;
    if (way + half < speed * times.to) times.to = (way + half) / speed;
  }
}

}  // namespace radar::cpu
