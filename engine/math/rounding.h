// Rounding errors, and directed rounding of doubles to floats.
#pragma once

#include <bit>
#include <cstdint>

namespace radar {

/// 2^-53: bound on the relative rounding error of an operation in double.
inline constexpr double kUnit = 0x1p-53;

/// 2^exponent; -1022 <= exponent <= 1023.
inline double powerOfTwo(int exponent) {
  return std::bit_cast<double>(static_cast<uint64_t>(exponent + 1023) << 52);
}

/// The exponent of a normal number above 0: std::ilogb, inline.
inline int exponentOf(double x) {
  return static_cast<int>(std::bit_cast<uint64_t>(x) >> 52) - 1023;
}

/// The least float above `x`, which is finite: std::nextafter, inline.
inline float nextAbove(float x) {
  const auto bits = std::bit_cast<uint32_t>(x);
  return std::bit_cast<float>(bits << 1 == 0 ? 1 : (bits >> 31) == 0 ? bits + 1 : bits - 1);
}

/// The least float not below `x`; infinity if there is none.
inline float roundUp(double x) {
  const auto nearest = static_cast<float>(x);
  // nextAbove without branches, which would be mispredicted every other time; 0 has no sign if it is below x.
  const auto bits = std::bit_cast<uint32_t>(nearest), step = static_cast<uint32_t>(nearest < x);
  return std::bit_cast<float>((bits >> 31) == 0 ? bits + step : bits - step);
}

/// The greatest float not above `x`; minus infinity if there is none.
inline float roundDown(double x) {
  return -roundUp(-x);
}

/// Two floats whose sum is within 2^-48 of `x`, relative to it.
struct TwoFloats {
  float high, low;
};
inline TwoFloats twoFloats(double x) {
  const volatile float high = static_cast<float>(x);  // GCC 12.2 vectorises x - static_cast<float>(x) to 0
  return {high, static_cast<float>(x - high)};
}

}  // namespace radar
