// Unevaluated sums of two doubles, 106 bits: the second filter, between doubles and exact integers.
// T. J. Dekker, "A floating-point technique for extending the available precision", 1971; the error bounds are those of
// M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of double-word
// arithmetic", 2017, with u = 2^-53: sum 3u^2 + O(u^3), product less than 7u^2 (their AccurateDWPlusDW, DWTimesDW1).
#pragma once

#include <cmath>
#include <compare>

namespace radar::exact {

struct DoubleDouble {
  double high = 0, low = 0;
  friend auto operator<=>(const DoubleDouble&, const DoubleDouble&) = default;
};

/// high + low = p + q exactly, |p| >= |q| or p = 0.
inline DoubleDouble quickSum(double p, double q) {
  const double s = p + q;
  return {s, q - (s - p)};
}

/// high + low = p + q exactly.
inline DoubleDouble sum(double p, double q) {
  const double s = p + q, qPart = s - p;
  return {s, (p - (s - qPart)) + (q - qPart)};
}

inline DoubleDouble difference(double p, double q) {
  return sum(p, -q);
}

/// high + low = p * q exactly, barring overflow and underflow.
inline DoubleDouble product(double p, double q) {
  constexpr double kSplit = 0x1p27 + 1;
  const double pc = kSplit * p, qc = kSplit * q;
  const double p1 = pc - (pc - p), p2 = p - p1, q1 = qc - (qc - q), q2 = q - q1;
  const double r = p * q;
  return {r, ((p1 * q1 - r) + p1 * q2 + p2 * q1) + p2 * q2};
}

inline DoubleDouble operator-(const DoubleDouble& p) {
  return {-p.high, -p.low};
}

inline DoubleDouble operator+(const DoubleDouble& p, const DoubleDouble& q) {
  const DoubleDouble s = sum(p.high, q.high), t = sum(p.low, q.low);
  const DoubleDouble v = quickSum(s.high, s.low + t.high);
  return quickSum(v.high, t.low + v.low);
}

inline DoubleDouble operator-(const DoubleDouble& p, const DoubleDouble& q) {
  return p + -q;
}

inline DoubleDouble operator*(const DoubleDouble& p, const DoubleDouble& q) {
  const DoubleDouble r = product(p.high, q.high);
  return quickSum(r.high, r.low + (p.high * q.low + p.low * q.high));
}

/// p / q, off by less than 16u^2 of itself.
inline DoubleDouble operator/(const DoubleDouble& p, const DoubleDouble& q) {
  const double first = p.high / q.high;
  const DoubleDouble rest = p - DoubleDouble{first} * q;
  const double second = rest.high / q.high;
  const DoubleDouble last = rest - DoubleDouble{second} * q;
  return quickSum(first, second) + DoubleDouble{last.high / q.high};
}

/// The square root of x >= 0, off by less than 16u^2 of itself.
inline DoubleDouble root(const DoubleDouble& x) {
  if (!(x.high > 0)) return {};
  const double first = std::sqrt(x.high);
  return quickSum(first, (x - product(first, first)).high / (2 * first));
}

}  // namespace radar::exact
