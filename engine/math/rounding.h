// Directed rounding of doubles to floats.
#pragma once

#include <bit>
#include <cstdint>

namespace radar {

/// The least float not below `x`; infinity if there is none.
inline float roundUp(double x) {
  const auto nearest = static_cast<float>(x);
  if (nearest >= x) return nearest;
  // std::nextafter, inline.
  const auto bits = std::bit_cast<uint32_t>(nearest);
  return std::bit_cast<float>(bits << 1 == 0 ? 1 : (bits >> 31) == 0 ? bits + 1 : bits - 1);
}

/// The greatest float not above `x`; minus infinity if there is none.
inline float roundDown(double x) {
  return -roundUp(-x);
}

}  // namespace radar
