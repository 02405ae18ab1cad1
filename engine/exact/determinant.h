// Determinants of differences of points, in three strengths: doubles, twofold doubles, exact. The first two come with a
// proven bound on their error (docs/exact.md), which holds for all finite input, underflow included; where something
// overflows, the bound is not finite, so that every test against it fails and the next strength is asked.
#pragma once

#include <cmath>

#include "exact/contact.h"
#include "exact/dyadic.h"
#include "exact/twofold.h"

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
  Twofold value;
  double error;
};

Estimate estimate(const Determinant& d);
FineEstimate fineEstimate(const Determinant& d);
Dyadic exactly(const Determinant& d);

/// -1, 0 or 1, by doubles where they suffice.
int sign(const Determinant& d);
/// The same where doubles are known not to suffice.
int exactSign(const Determinant& d);

/// Sign of component `axis` of v cross w.
int crossSign(const Difference& v, const Difference& w, int axis);

// Each summand w_k (x_i y_j) passes 8 roundings at most: three differences, two products, three sums. The magnitude is
// itself rounded, so 16 where 8 (1 + O(u)) would do. (J. R. Shewchuk, "Adaptive precision floating-point arithmetic and
// fast robust geometric predicates", 1997, section 4, has this kind of bound.)
inline constexpr double kRelative = 16 * 0x1p-53;
// Each product may lose less than 2^-1070 to underflow, and is then multiplied by a component of w.
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
  return kUnderflow * (1 + (std::abs(w[0]) + std::abs(w[1]) + std::abs(w[2])));
}

inline Vector rounded(const Difference& d) {
  return {d.to[0] - d.from[0], d.to[1] - d.from[1], d.to[2] - d.from[2]};
}

inline int signOf(double v) {
  return v > 0 ? 1 : v < 0 ? -1 : 0;
}

/// The origin: makes a difference of a vector.
inline constexpr Vector kOrigin{};

/// To be called wherever exact integers had to decide: keeps the count that exactDecisions() gives.
void countExactDecision();

}  // namespace radar::exact
