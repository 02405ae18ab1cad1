#include "scene/placement.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/rounding.h"

namespace radar {

namespace {

// Entries of an inverse matrix, and their residuals, are out of range from here on.
constexpr double kMostInverse = 0x1p100;
// Bounds on what a device flushes to 0, as in placement.glsl: in all, and of vertices, before and after they are
// normalised.
constexpr double kFlushed = 4e-36, kFlushedVertex = 3e-37;

// The leading 16 bits, so that the shader's products with 8-bit numbers are exact.
float leadingBits(double x) {
  return std::bit_cast<float>(std::bit_cast<uint32_t>(static_cast<float>(x)) & 0xffffff00u);
}

using Matrix = std::array<double, 9>;

// The inverse, except for rounding. Any rows would be valid, since setInverse() computes their residual.
Matrix inverseOf(const Matrix& m) {
  const double a = m[4] * m[8] - m[5] * m[7], b = m[5] * m[6] - m[3] * m[8], c = m[3] * m[7] - m[4] * m[6];
  const double inverse = 1 / (m[0] * a + m[1] * b + m[2] * c);
  return {a * inverse, (m[2] * m[7] - m[1] * m[8]) * inverse, (m[1] * m[5] - m[2] * m[4]) * inverse,
          b * inverse, (m[0] * m[8] - m[2] * m[6]) * inverse, (m[2] * m[3] - m[0] * m[5]) * inverse,
          c * inverse, (m[1] * m[6] - m[0] * m[7]) * inverse, (m[0] * m[4] - m[1] * m[3]) * inverse};
}

// Sets the inverse rows and their residuals. Returns whether floats hold them.
bool setInverse(gpu::Placement& out, const Matrix& matrix) {
  const Matrix inverse = inverseOf(matrix);
  for (int row = 0; row < 3; ++row) {
    float* n = &out.inverse[4 * row];
    for (int k = 0; k < 3; ++k) {
      if (!(std::abs(inverse[3 * row + k]) < kMostInverse)) return false;
      n[k] = static_cast<float>(inverse[3 * row + k]);
    }
    double off = 0, sum = 0;
    for (int j = 0; j < 3; ++j) {
      double product = j == row ? -1 : 0, magnitude = 1;
      for (int k = 0; k < 3; ++k) {
        product += double(n[k]) * matrix[3 * k + j];
        magnitude += std::abs(n[k] * matrix[3 * k + j]);
      }
      off += std::abs(product) * out.reach[j];
      sum += magnitude * out.reach[j];
    }
    // The factor covers shaders' sums with this number, which may round down.
    n[3] = roundUp(1.00001 * (off + 0x1p-48 * sum));
    if (!(n[3] < kMostInverse)) return false;
  }
  return true;
}

}  // namespace

gpu::Placement placementOf(const Mesh& mesh, const Transform& worldFromMesh) {
  gpu::Placement out{};
  Matrix matrix;
  double size = 0, magnitude = 0, most = 0;
  for (int k = 0; k < 3; ++k) {
    out.reach[k] = static_cast<float>(mesh.reach[k] / mesh.unit);
    out.origin[k] = static_cast<float>(mesh.origin[k]);
    magnitude = std::max(magnitude, std::abs(mesh.origin[k]));
  }
  for (int row = 0; row < 3; ++row) {
    const double* r = &worldFromMesh.m[4 * row];
    const double sum = magnitudeAlong(r, mesh.span());
    double position = r[3], entries = 0;
    for (int k = 0; k < 3; ++k) {
      matrix[3 * row + k] = r[k] * mesh.unit;
      position += r[k] * mesh.origin[k];
      size += std::abs(r[k]) * mesh.reach[k];
      most = std::max(most, std::abs(matrix[3 * row + k]));
      entries += std::abs(r[k]) + std::abs(matrix[3 * row + k]);
      out.coarse[4 * row + k] = leadingBits(matrix[3 * row + k]);
      out.fine[4 * row + k] = static_cast<float>(matrix[3 * row + k] - out.coarse[4 * row + k]);
    }
    magnitude = std::max(magnitude, sum);
    out.coarse[4 * row + 3] = static_cast<float>(position);
    out.fine[4 * row + 3] = static_cast<float>(position - out.coarse[4 * row + 3]);
    // Covers the rounding of placing, of the position's two parts and of the shader's sums of them, also of fine parts.
    out.error = std::max(out.error, roundUp(0x1p-44 * sum + kFlushedVertex * entries));
  }
  out.size = roundUp(size);
  out.error = roundUp(double(out.error) + 0x1p-35 * size + kFlushed);
  const bool inRange = magnitude <= kMostCoordinate && most <= kMostCoordinate && most >= 1 / kMostCoordinate &&
                       mesh.unit <= kMostCoordinate && mesh.unit >= 1 / kMostCoordinate;
  if (!inRange || !setInverse(out, matrix)) return {};
  out.perUnit = static_cast<float>(1 / mesh.unit);
  return out;
}

}  // namespace radar
