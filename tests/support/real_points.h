// Points in long doubles.
#pragma once

#include <array>
#include <cmath>

namespace radar::test {

using Real = long double;
using Point = std::array<Real, 3>;

inline constexpr Real kNever = INFINITY;

inline Point operator+(const Point& a, const Point& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Point operator*(Real s, const Point& a) {
  return {s * a[0], s * a[1], s * a[2]};
}
inline Point operator-(const Point& a, const Point& b) {
  return a + (-1) * b;
}
inline Real dot(const Point& a, const Point& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace radar::test
