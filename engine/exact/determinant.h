// Determinants of differences of points at three precisions: doubles, double-doubles, exact. The first two have a
// proven error bound (docs/exact.md) for all finite input, underflow included. On overflow the bound is not finite, so
// every test against it fails and the next precision is used.
#pragma once

#include <cmath>

#include "exact/contact.h"
#include "exact/double_double.h"
#include "exact/dyadic.h"

namespace radar::exact {

/// The vector to - from, not rounded.
struct Difference {
  const Vector& from;
  const Vector& to;
};

/// w . (x cross y).
struct Determinant {
  Difference w, x, y;
};

struct Estimate {
  double value, error;  ///< |value - exact| <= error
};
struct FineEstimate {
  DoubleDouble value;
  double error;
};

Estimate estimate(const Determinant& d);

/// x cross y, for determinants w . (x cross y).
class FineCross {
 public:
  FineCross(const Difference& x, const Difference& y);
  FineEstimate along(const Difference& w) const;

 private:
  DoubleDouble minors_[3];
  double sizes_[3];
};
inline FineEstimate fineEstimate(const Determinant& d) {
  return FineCross(d.x, d.y).along(d.w);
}
Dyadic exactly(const Determinant& d);

/// -1, 0 or 1; uses doubles if they suffice.
int sign(const Determinant& d);
/// The same, if doubles are known not to suffice.
int exactSign(const Determinant& d);

/// Sign of component `axis` of v cross w.
int crossSign(const Difference& v, const Difference& w, int axis);

// Each summand w_k (x_i y_j) passes at most 8 roundings: three differences, two products, three sums. 8 (1 + O(u))
// would do; 16 covers the rounding of the magnitude. (J. R. Shewchuk, "Adaptive precision floating-point arithmetic and
// fast robust geometric predicates", 1997, section 4, derives bounds of this kind.)
inline constexpr double kRelative = 16 * 0x1p-53;
// Underflow costs each product less than 2^-1070; the product is then multiplied by a component of w.
inline constexpr double kUnderflow = 0x1p-1000;

/// The determinant of three differences whose components were rounded once. `floor` is at least kUnderflow (1 + |w|).
inline Estimate estimate(const Vector& w, const Vector& x, const Vector& y, double floor) {
  const double p0 = x[1] * y[2], p1 = x[2] * y[0], p2 = x[0] * y[1];
  const double q0 = x[2] * y[1], q1 = x[0] * y[2], q2 = x[1] * y[0];
  const double value = w[0] * (p0 - q0) + w[1] * (p1 - q1) + w[2] * (p2 - q2);
  const double magnitude = std::abs(w[0]) * (std::abs(p0) + std::abs(q0)) +
                           std::abs(w[1]) * (std::abs(p1) + std::abs(q1)) +
                           std::abs(w[2]) * (std::abs(p2) + std::abs(q2));
  return {value, kRelative * magnitude + floor};
}

inline double underflowOf(const Vector& w) {
  return kUnderflow * (1 + norm1(w));
}

inline Vector rounded(const Difference& d) {
  return {d.to[0] - d.from[0], d.to[1] - d.from[1], d.to[2] - d.from[2]};
}

inline int signOf(double v) {
  return v > 0 ? 1 : v < 0 ? -1 : 0;
}

/// The origin, to treat a vector as a difference.
inline constexpr Vector kOrigin{};

}  // namespace radar::exact
