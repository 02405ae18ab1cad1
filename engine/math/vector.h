// Vectors and affine maps in double precision. Not Eigen's, whose order of operations depends on the
// compiler's flags: docs/exact.md.
#pragma once

#include <array>

namespace radar {

using Vector = std::array<double, 3>;
using Affine = std::array<double, 12>;  ///< row-major 3x4

inline double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace radar
