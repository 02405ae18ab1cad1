// A double and a bound on its error: the filter before exact arithmetic, for expressions too long to bound by hand.
#pragma once

#include <cmath>
#include <limits>

namespace radar::exact {

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
    double error = std::abs(p.value_) * q.error_ + std::abs(q.value_) * p.error_ + p.error_ * q.error_;
    error = (error + kUnit * std::abs(value)) * kMore;
    // What may have underflowed has no bound.
    const bool isTiny = std::abs(value) < kTiny && p.value_ != 0 && q.value_ != 0;
    return {value, isTiny || (error < kTiny && error != 0) ? std::numeric_limits<double>::infinity() : error};
  }
  /// The greater of two numbers. Errors are added because std::max may drop one that is not a number.
  friend Bounded max(const Bounded& p, const Bounded& q) {
    return {p.value_ >= q.value_ ? p.value_ : q.value_, p.error_ + q.error_};
  }
  friend Bounded abs(const Bounded& p) { return {std::abs(p.value_), p.error_}; }

 private:
  Bounded(double value, double error) : value_(value), error_(error) {}
  static Bounded sum(double value, double error) { return {value, (error + kUnit * std::abs(value)) * kMore}; }

  static constexpr double kUnit = 0x1p-53, kMore = 1 + 0x1p-49, kTiny = 0x1p-960;

  double value_ = 0, error_ = 0;  // |value_ - exact| <= error_
};

}  // namespace radar::exact
