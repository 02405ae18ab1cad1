// Vectors and affine maps in double precision. Sums run from left to right, so that answers have the same bits
// everywhere. Not Eigen's, whose order of operations depends on the compiler's flags: docs/exact.md.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace radar {

using Vector = std::array<double, 3>;
using Affine = std::array<double, 12>;  ///< row-major 3x4

template <class Number>
std::array<Number, 3> minus(const std::array<Number, 3>& a, const std::array<Number, 3>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

inline Vector scaled(double factor, const Vector& v) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}

/// p + s d.
inline Vector along(const Vector& p, double s, const Vector& d) {
  return {p[0] + s * d[0], p[1] + s * d[1], p[2] + s * d[2]};
}

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// The largest component's absolute value.
inline double largest(const Vector& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

/// The sum of the components' absolute values.
inline double norm1(const Vector& v) {
  return std::abs(v[0]) + std::abs(v[1]) + std::abs(v[2]);
}

/// Bound on |a . b| for any b with components of at most `sizes`.
inline double reachAlong(const Vector& a, const Vector& sizes) {
  return std::abs(a[0]) * sizes[0] + std::abs(a[1]) * sizes[1] + std::abs(a[2]) * sizes[2];
}

}  // namespace radar
