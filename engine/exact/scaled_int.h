// Points as 64-bit integers times a common power of two: the fast path of exact arithmetic. It takes nearly all
// coordinates that span at most sixty binary places; dyadic.h takes the others.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "exact/determinant.h"
#include "exact/dyadic.h"

namespace radar::exact {

using IntVector = std::array<int64_t, 3>;

/// points[n] = out[n] * 2^exponent, components below 2^61. False if they do not fit.
bool toScaledInts(std::span<const Vector* const> points, std::span<IntVector> out, int& exponent);

/// A difference, components below 2^62.
struct ScaledVector {
  IntVector c;
  int exponent;
};
std::optional<ScaledVector> scaledVector(const Difference& v);

inline IntVector operator-(const IntVector& p, const IntVector& q) {
  return {p[0] - q[0], p[1] - q[1], p[2] - q[2]};
}

/// x cross y, components of x and y below 2^62: those of the product are below 2^125.
__extension__ using IntNormal = std::array<__int128, 3>;
IntNormal cross(const IntVector& x, const IntVector& y);

/// 192 bits, two's complement.
class IntDeterminant {
 public:
  int sign() const;
  Dyadic value(int exponent) const;  ///< this, times 2^exponent

 private:
  friend IntDeterminant dot(const IntVector& w, const IntNormal& n);
  std::array<uint64_t, 3> limbs_{};
};

/// w . n, components of w below 2^62: below 2^189.
IntDeterminant dot(const IntVector& w, const IntNormal& n);

/// w . (x cross y).
inline IntDeterminant determinant(const IntVector& w, const IntVector& x, const IntVector& y) {
  return dot(w, cross(x, y));
}

}  // namespace radar::exact
