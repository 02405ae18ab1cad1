// Directed rounding of doubles to floats.
#pragma once

#include <cmath>

namespace radar {

/// The least float not below `x`; infinity if there is none.
inline float roundUp(double x) {
  const auto nearest = static_cast<float>(x);
  return nearest >= x ? nearest : std::nextafter(nearest, INFINITY);
}

/// The greatest float not above `x`; minus infinity if there is none.
inline float roundDown(double x) {
  return -roundUp(-x);
}

}  // namespace radar
