// A double and a bound on its error: the filter before exact arithmetic, for expressions too long to bound by hand.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "math/rounding.h"

namespace radar::exact {

/// For sums of products of at most four numbers that hasSafeRange() admits, and their differences: then nothing
/// overflows, and products and their errors are 0 or far above underflow.
class Bounded {
 public:
  Bounded() = default;
  explicit Bounded(double value) : value_(value) {}  ///< exact

  /// -1 or 1 if the sign is certain. 0: the number is certainly 0, or its sign is not known.
  int sign() const { return value_ > error_ ? 1 : value_ < -error_ ? -1 : 0; }
  bool isCertain() const { return std::abs(value_) > error_ || error_ == 0; }

  friend Bounded operator+(const Bounded& p, const Bounded& q) { return sum(p.value_ + q.value_, p.error_ + q.error_); }
  friend Bounded operator-(const Bounded& p, const Bounded& q) { return sum(p.value_ - q.value_, p.error_ + q.error_); }
  friend Bounded operator*(const Bounded& p, const Bounded& q) {
    const double value = p.value_ * q.value_;
    return {value, (spread(p, q) + kUnit * std::abs(value)) * kMore};
  }
  /// p q - r s.
  friend Bounded minor(const Bounded& p, const Bounded& q, const Bounded& r, const Bounded& s) {
    const double first = p.value_ * q.value_, second = r.value_ * s.value_;
    return {first - second, (spread(p, q) + spread(r, s) + 2 * kUnit * (std::abs(first) + std::abs(second))) * kMore};
  }
  friend Bounded inner(const std::array<Bounded, 3>& p, const std::array<Bounded, 3>& q) {
    const double x = p[0].value_ * q[0].value_, y = p[1].value_ * q[1].value_, z = p[2].value_ * q[2].value_;
    return {x + y + z, (spread(p[0], q[0]) + spread(p[1], q[1]) + spread(p[2], q[2]) +
                        3 * kUnit * (std::abs(x) + std::abs(y) + std::abs(z))) *
                           kMore};
  }
  friend Bounded max(const Bounded& p, const Bounded& q) {
    return {std::max(p.value_, q.value_), std::max(p.error_, q.error_)};
  }
  friend Bounded abs(const Bounded& p) { return {std::abs(p.value_), p.error_}; }

 private:
  Bounded(double value, double error) : value_(value), error_(error) {}
  static Bounded sum(double value, double error) { return {value, (error + kUnit * std::abs(value)) * kMore}; }
  /// How far the product may be from that of the values.
  static double spread(const Bounded& p, const Bounded& q) {
    return std::abs(p.value_) * q.error_ + p.error_ * (std::abs(q.value_) + q.error_);
  }

  static constexpr double kMore = 1 + 0x1p-49;

  double value_ = 0, error_ = 0;  // |value_ - exact| <= error_
};

/// Whether a number is 0 or of moderate size.
inline bool hasSafeRange(double v) {
  const double size = std::abs(v);
  return (int(v == 0) | (int(size > 0x1p-100) & int(size < 0x1p100))) != 0;
}

}  // namespace radar::exact
