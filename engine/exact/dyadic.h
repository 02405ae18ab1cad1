// Exact integers times powers of two: sums and products of doubles, unrounded. Sign and magnitude, 64-bit limbs, fixed
// size, no allocation; only limbs in use are touched.
//
// The size suffices for every expression of engine/exact over *all* finite doubles. The largest is num^2 *
// |direction|^2 - D^2 * den^2, with num and den determinants of three differences: its unit is at least 2^-8592 and its
// value below 2^8207, so 263 limbs.
#pragma once

#include <array>
#include <cstdint>

namespace radar::exact {

class Dyadic {
 public:
  Dyadic() {}
  explicit Dyadic(double value);  ///< finite
  /// (negative ? -1 : 1) * (limbs, lowest first, as one integer) * 2^exponent.
  Dyadic(bool negative, const std::array<uint64_t, 3>& limbs, int exponent);
  Dyadic(const Dyadic& other) { *this = other; }
  Dyadic& operator=(const Dyadic& other);

  int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

  friend Dyadic operator*(const Dyadic& p, const Dyadic& q);
  friend Dyadic operator+(const Dyadic& p, const Dyadic& q) { return sum(p, q, false); }
  friend Dyadic operator-(const Dyadic& p, const Dyadic& q) { return sum(p, q, true); }
  /// num / den rounded to the nearest double, ties to even; the result may be subnormal, zero or infinite.
  friend double quotient(const Dyadic& num, const Dyadic& den);

 private:
  static constexpr uint32_t kLimbs = 272;

  static Dyadic sum(const Dyadic& p, const Dyadic& q, bool negateQ);
  static int compareMagnitudes(const Dyadic& p, const Dyadic& q);
  uint32_t bits() const;
  void shiftLeft(uint32_t count);
  void addMagnitude(const Dyadic& q);
  void subtractMagnitude(const Dyadic& q);
  void trim();

  // value = (negative_ ? -1 : 1) * (limbs as one integer) * 2^exponent_; the highest limb in use is not zero.
  uint32_t size_ = 0;
  bool negative_ = false;
  int32_t exponent_ = 0;
  std::array<uint64_t, kLimbs> limbs_;  // NOLINT: those beyond size_ have no value
};

}  // namespace radar::exact
