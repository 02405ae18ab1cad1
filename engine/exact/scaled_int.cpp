#include "exact/scaled_int.h"

#include <algorithm>
#include <bit>

namespace radar::exact {

namespace {

__extension__ using Wide = __int128;
__extension__ using WideUnsigned = unsigned __int128;
using Limbs = std::array<uint64_t, 3>;

void negate(Limbs& limbs) {
  WideUnsigned carry = 1;
  for (uint64_t& limb : limbs) {
    carry += ~limb;
    limb = static_cast<uint64_t>(carry);
    carry >>= 64;
  }
}

void addProduct(Limbs& sum, Wide p, int64_t q) {
  const WideUnsigned m = p < 0 ? -static_cast<WideUnsigned>(p) : static_cast<WideUnsigned>(p);
  const uint64_t n = q < 0 ? -static_cast<uint64_t>(q) : static_cast<uint64_t>(q);
  const WideUnsigned low = WideUnsigned{static_cast<uint64_t>(m)} * n;
  const WideUnsigned high = WideUnsigned{static_cast<uint64_t>(m >> 64)} * n + static_cast<uint64_t>(low >> 64);
  Limbs product{static_cast<uint64_t>(low), static_cast<uint64_t>(high), static_cast<uint64_t>(high >> 64)};
  if ((p < 0) != (q < 0)) negate(product);
  WideUnsigned carry = 0;
  for (int i = 0; i < 3; ++i) {
    carry += WideUnsigned{sum[i]} + product[i];
    sum[i] = static_cast<uint64_t>(carry);
    carry >>= 64;
  }
}

/// Mantissa and exponent of a double that is not 0.
struct Parts {
  uint64_t digits = 0;
  int exponent = 0;
  bool negative = false;

  explicit Parts(double value) {
    const uint64_t image = std::bit_cast<uint64_t>(value);
    const int field = static_cast<int>(image >> 52 & 0x7ff);
    digits = (image & ((uint64_t{1} << 52) - 1)) | (field != 0 ? uint64_t{1} << 52 : 0);
    exponent = std::max(field, 1) - 1075;
    negative = image >> 63 != 0;
  }
};

}  // namespace

bool toScaledInts(std::span<const Vector* const> points, std::span<IntVector> out, int& exponent) {
  constexpr int kNone = 5000;
  int low = kNone, high = -kNone;
  for (const Vector* point : points) {
    for (double c : *point) {
      if (c == 0) continue;
      const Parts parts(c);
      low = std::min(low, parts.exponent + std::countr_zero(parts.digits));
      high = std::max(high, parts.exponent + 64 - std::countl_zero(parts.digits));
    }
  }
  if (high - low > 61) return false;
  exponent = low == kNone ? 0 : low;
  for (size_t n = 0; n < points.size(); ++n) {
    for (size_t k = 0; k < 3; ++k) {
      const double c = (*points[n])[k];
      out[n][k] = 0;
      if (c == 0) continue;
      const Parts parts(c);
      const int shift = parts.exponent - exponent;
      const uint64_t size = shift >= 0 ? parts.digits << shift : parts.digits >> -shift;
      out[n][k] = parts.negative ? -static_cast<int64_t>(size) : static_cast<int64_t>(size);
    }
  }
  return true;
}

std::optional<ScaledVector> scaledVector(const Difference& v) {
  // Of an edge along an axis, one coordinate matters.
  Vector to = v.to, from = v.from;
  for (int k = 0; k < 3; ++k) {
    if (to[k] == from[k]) to[k] = from[k] = 0;
  }
  const std::array<const Vector*, 2> points{&to, &from};
  std::array<IntVector, 2> at;
  ScaledVector out;
  if (!toScaledInts(points, at, out.exponent)) return std::nullopt;
  out.c = at[0] - at[1];
  return out;
}

int IntDeterminant::sign() const {
  if (static_cast<int64_t>(limbs_[2]) < 0) return -1;
  return (limbs_[0] | limbs_[1] | limbs_[2]) != 0;
}

Dyadic IntDeterminant::value(int exponent) const {
  Limbs limbs = limbs_;
  const bool negative = sign() < 0;
  if (negative) negate(limbs);
  return Dyadic(negative, limbs, exponent);
}

IntNormal cross(const IntVector& x, const IntVector& y) {
  IntNormal n;
  for (size_t k = 0; k < 3; ++k) {
    const size_t i = k == 2 ? 0 : k + 1, j = k == 0 ? 2 : k - 1;
    n[k] = Wide{x[i]} * y[j] - Wide{x[j]} * y[i];
  }
  return n;
}

IntDeterminant dot(const IntVector& w, const IntNormal& n) {
  IntDeterminant out;
  for (size_t k = 0; k < 3; ++k) {
    if (n[k] != 0 && w[k] != 0) addProduct(out.limbs_, n[k], w[k]);
  }
  return out;
}

}  // namespace radar::exact
