// Doubles to floats in a known direction.
#pragma once

#include <cmath>

namespace radar {

/// The least float not below `x`; infinity where there is none.
inline float roundUp(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest >= x ? nearest : std::nextafter(nearest, INFINITY);
}

/// The greatest float not above `x`; minus infinity where there is none.
inline float roundDown(double x) {
  return -roundUp(-x);
}

}  // namespace radar
