// Vectors, rotations and poses, with the same bits on every platform.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "radar/radar.h"

namespace radar::tools {

using Vec3 = std::array<double, 3>;
using Rotation = std::array<double, 9>;  ///< row-major

inline constexpr Vec3 kFull{1, 1, 1};  ///< a scale
inline constexpr Rotation kUpright{1, 0, 0, 0, 1, 0, 0, 0, 1};
inline constexpr Rotation kOnEdge{1, 0, 0, 0, 0, -1, 0, 1, 0};  ///< y upwards

constexpr Vec3 operator+(const Vec3& a, const Vec3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
constexpr Vec3 operator-(const Vec3& a, const Vec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
constexpr Vec3 operator*(double factor, const Vec3& v) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}
constexpr double dot(const Vec3& a, const Vec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline double lengthOf(const Vec3& v) {
  return std::sqrt(dot(v, v));
}

constexpr Vec3 turned(const Rotation& r, const Vec3& v) {
  return {r[0] * v[0] + r[1] * v[1] + r[2] * v[2], r[3] * v[0] + r[4] * v[1] + r[5] * v[2],
          r[6] * v[0] + r[7] * v[1] + r[8] * v[2]};
}
constexpr Rotation product(const Rotation& p, const Rotation& q) {
  Rotation out{};
  for (size_t i = 0; i < 9; ++i) {
    for (size_t k = 0; k < 3; ++k) out[i] += p[i / 3 * 3 + k] * q[3 * k + i % 3];
  }
  return out;
}

/// World = rotation * diag(scale) * p + at.
constexpr Transform makePose(const Rotation& rotation, const Vec3& scale, const Vec3& at) {
  Transform pose;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) pose.m[4 * row + k] = rotation[3 * row + k] * scale[k];
    pose.m[4 * row + 3] = at[row];
  }
  return pose;
}
constexpr Transform placedAt(const Vec3& where) {
  return makePose(kUpright, kFull, where);
}
/// The rotation, scale and shear of a pose.
constexpr Rotation linearPart(const Transform& pose) {
  const auto& m = pose.m;
  return {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
}
/// Whether a pose turns a mesh inside out.
inline bool mirrors(const Transform& pose) {
  double rows[3][3];  // scaled, so that products neither overflow nor underflow
  for (unsigned row = 0; row < 3; ++row) {
    double most = 0;
    for (unsigned k = 0; k < 3; ++k) most = std::fmax(most, std::abs(pose.m[4 * row + k]));
    if (most == 0) return false;
    for (unsigned k = 0; k < 3; ++k) rows[row][k] = pose.m[4 * row + k] / most;
  }
  const auto& [a, b, c] = rows;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]) <
         0;
}
constexpr void moveBy(Transform& pose, const Vec3& offset) {
  for (size_t k = 0; k < 3; ++k) pose.m[4 * k + 3] += offset[k];
}

/// A box along the axes; empty at first.
struct Bounds {
  Vec3 low{INFINITY, INFINITY, INFINITY}, high{-INFINITY, -INFINITY, -INFINITY};
  void add(const Vec3& p) {
    for (size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  }
  double longest() const { return std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]}); }
};
/// Of the vertices that triangles use.
inline Bounds boundsOf(const MeshView& mesh, const Transform& pose) {
  Bounds bounds;
  for (const uint32_t vertex : mesh.indices) bounds.add(transformPoint(pose, &mesh.positions[3 * size_t{vertex}]));
  return bounds;
}

}  // namespace radar::tools
