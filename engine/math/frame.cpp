#include "math/frame.h"

#include <cmath>
#include <optional>

#include "math/rounding.h"

namespace radar {

namespace {

Vector unit(Vector v) {
  const double size = largest(v);
  for (double& x : v) x /= size;
  const double length = std::hypot(v[0], v[1], v[2]);
  for (double& x : v) x /= length;
  return v;
}

// Across a direction of length 1, and across the axis to which that is nearest to a right angle.
Vector acrossFrom(const Vector& forward) {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(forward[k]) < std::abs(forward[least])) least = k;
  }
  Vector axis{};
  axis[least] = 1;
  return cross(forward, axis);
}

}  // namespace

Vector normalized(Vector v) {
  const double size = largest(v);
  for (double& x : v) x /= size;
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x /= length;
  return v;
}

Vector scaledDirection(const Vector& direction) {
  const double size = largest(direction);
  // All but directions of extreme lengths.
  if (size >= 0x1p-1000 && size <= 0x1p1000) {
    const double factor = powerOfTwo(-exponentOf(size)), inverse = powerOfTwo(exponentOf(size));
    const Vector out = scaled(factor, direction);
    if (scaled(inverse, out) == direction) return out;
  }
  const auto scaledBy = [&](int exponent) -> std::optional<Vector> {
    Vector out;
    for (int k = 0; k < 3; ++k) {
      out[k] = std::scalbn(direction[k], -exponent);
      if (std::scalbn(out[k], exponent) != direction[k]) return std::nullopt;
    }
    return out;
  };
  // Otherwise at least so that its length does not overflow.
  return scaledBy(std::ilogb(size)).value_or(size >= 0x1p1022 ? scaledBy(2).value_or(direction) : direction);
}

double lengthOf(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

std::array<Vector, 3> axesAlong(const Vector& direction) {
  const Vector forward = unit(direction), up = unit(acrossFrom(forward));
  return {cross(up, forward), up, forward};
}

std::array<Vector, 3> axesAlongUnit(const Vector& forward) {
  // Its square is at least 2/3.
  const Vector across = acrossFrom(forward), up = scaled(1 / std::sqrt(dot(across, across)), across);
  return {cross(up, forward), up, forward};
}

Vector transform(const Transform& pose, const Vector& p) {
  Vector out;
  for (int k = 0; k < 3; ++k) {
    const double* r = &pose.m[4 * k];
    out[k] = ((r[0] * p[0] + r[1] * p[1]) + r[2] * p[2]) + r[3];
  }
  return out;
}

Affine frameFromLocal(const std::array<Vector, 3>& axes, const Vector& origin, const Transform& pose,
                      const Vector& centre) {
  const Vector offset = minus(transform(pose, centre), origin);
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      out[4 * row + column] =
          axes[row][0] * pose.m[column] + axes[row][1] * pose.m[4 + column] + axes[row][2] * pose.m[8 + column];
    }
    out[4 * row + 3] = dot(axes[row], offset);
  }
  return out;
}

}  // namespace radar
