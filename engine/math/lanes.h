// Four floats or doubles at a time, with the vector extension of GCC and Clang: it needs only the instructions that
// every 64-bit processor has.
#pragma once

#include <cstdint>

namespace radar {

using FourFloats = float __attribute__((vector_size(16)));
using TwoDoubles = double __attribute__((vector_size(16)));

/// The signs of a vector's numbers, one bit each.
template <class Vector>
unsigned signsOf(const Vector& x) {
#ifdef __SSE2__
  if constexpr (sizeof(x[0]) == sizeof(float)) {
    return static_cast<unsigned>(__builtin_ia32_movmskps(FourFloats(x)));
  } else {
    return static_cast<unsigned>(__builtin_ia32_movmskpd(TwoDoubles(x)));
  }
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < sizeof(x) / sizeof(x[0]); ++i) bits |= unsigned{x[i] < 0} << i;
  return bits;
#endif
}

/// `min`, `max` and `select` compare x with y; if either is NaN they return the second choice, y or q.
template <class Real>
struct Lanes;

template <>
struct Lanes<float> {
  FourFloats v;
  Lanes() = default;
  Lanes(float x) : v{x, x, x, x} {}                          // NOLINT: in all lanes
  Lanes(FourFloats x) : v(x) {}                              // NOLINT
  Lanes(const float (&x)[4]) : v{x[0], x[1], x[2], x[3]} {}  // NOLINT
  float operator[](int i) const { return v[i]; }
  FourFloats floats() const { return v; }

  friend Lanes operator+(const Lanes& x, const Lanes& y) { return x.v + y.v; }
  friend Lanes operator-(const Lanes& x, const Lanes& y) { return x.v - y.v; }
  friend Lanes operator*(const Lanes& x, const Lanes& y) { return x.v * y.v; }
  friend Lanes operator/(const Lanes& x, const Lanes& y) { return x.v / y.v; }
  friend Lanes operator-(const Lanes& x) { return -x.v; }
  friend Lanes min(const Lanes& x, const Lanes& y) { return x.v < y.v ? x.v : y.v; }
  friend Lanes max(const Lanes& x, const Lanes& y) { return x.v > y.v ? x.v : y.v; }
  /// p if x > y, else q.
  friend Lanes select(const Lanes& x, const Lanes& y, const Lanes& p, const Lanes& q) { return x.v > y.v ? p.v : q.v; }
  /// One bit per lane: whether x > y.
  friend unsigned above(const Lanes& x, const Lanes& y) { return signsOf(x.v > y.v); }
  friend Lanes abs(const Lanes& x) { return FourFloats(Bits(x.v) & ~kSign); }
  /// x, with its sign changed where y is below 0.
  friend Lanes withSignOf(const Lanes& x, const Lanes& y) { return FourFloats(Bits(x.v) ^ (Bits(y.v) & kSign)); }

 private:
  using Bits = uint32_t __attribute__((vector_size(16)));
  static constexpr uint32_t kSign = 0x80000000u;
};

template <>
struct Lanes<double> {
  TwoDoubles low, high;
  Lanes() = default;
  Lanes(double x) : low{x, x}, high{x, x} {}  // NOLINT: in all lanes
  Lanes(TwoDoubles x, TwoDoubles y) : low(x), high(y) {}
  Lanes(const double (&x)[4]) : low{x[0], x[1]}, high{x[2], x[3]} {}  // NOLINT
  Lanes(FourFloats x) : low{x[0], x[1]}, high{x[2], x[3]} {}          // NOLINT
  double operator[](int i) const { return i < 2 ? low[i] : high[i - 2]; }
  /// Rounded to nearest.
  FourFloats floats() const {
    return FourFloats{static_cast<float>(low[0]), static_cast<float>(low[1]), static_cast<float>(high[0]),
                      static_cast<float>(high[1])};
  }

  friend Lanes operator+(const Lanes& x, const Lanes& y) { return {x.low + y.low, x.high + y.high}; }
  friend Lanes operator-(const Lanes& x, const Lanes& y) { return {x.low - y.low, x.high - y.high}; }
  friend Lanes operator*(const Lanes& x, const Lanes& y) { return {x.low * y.low, x.high * y.high}; }
  friend Lanes operator/(const Lanes& x, const Lanes& y) { return {x.low / y.low, x.high / y.high}; }
  friend Lanes operator-(const Lanes& x) { return {-x.low, -x.high}; }
  friend Lanes min(const Lanes& x, const Lanes& y) {
    return {x.low < y.low ? x.low : y.low, x.high < y.high ? x.high : y.high};
  }
  friend Lanes max(const Lanes& x, const Lanes& y) {
    return {x.low > y.low ? x.low : y.low, x.high > y.high ? x.high : y.high};
  }
  friend Lanes select(const Lanes& x, const Lanes& y, const Lanes& p, const Lanes& q) {
    return {x.low > y.low ? p.low : q.low, x.high > y.high ? p.high : q.high};
  }
  /// One bit per lane: whether x > y.
  friend unsigned above(const Lanes& x, const Lanes& y) {
    return signsOf(x.low > y.low) | signsOf(x.high > y.high) << 2;
  }
  friend Lanes abs(const Lanes& x) { return {TwoDoubles(Bits(x.low) & ~kSign), TwoDoubles(Bits(x.high) & ~kSign)}; }
  friend Lanes withSignOf(const Lanes& x, const Lanes& y) {
    return {TwoDoubles(Bits(x.low) ^ (Bits(y.low) & kSign)), TwoDoubles(Bits(x.high) ^ (Bits(y.high) & kSign))};
  }

 private:
  using Bits = uint64_t __attribute__((vector_size(16)));
  static constexpr uint64_t kSign = uint64_t{1} << 63;
};

template <class Real>
using LaneVec = Lanes<Real>[3];

template <class Real>
Lanes<Real> dot(const LaneVec<Real>& p, const LaneVec<Real>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class Real>
void cross(const LaneVec<Real>& p, const LaneVec<Real>& q, LaneVec<Real>& out) {
  out[0] = p[1] * q[2] - p[2] * q[1];
  out[1] = p[2] * q[0] - p[0] * q[2];
  out[2] = p[0] * q[1] - p[1] * q[0];
}

/// The columns of the matrix with these rows.
inline void transpose(const FourFloats (&rows)[4], FourFloats (&out)[4]) {
  const auto& [x, y, z, w] = rows;
  const FourFloats xyLow = __builtin_shufflevector(x, y, 0, 4, 1, 5),
                   xyHigh = __builtin_shufflevector(x, y, 2, 6, 3, 7);
  const FourFloats zwLow = __builtin_shufflevector(z, w, 0, 4, 1, 5),
                   zwHigh = __builtin_shufflevector(z, w, 2, 6, 3, 7);
  out[0] = __builtin_shufflevector(xyLow, zwLow, 0, 1, 4, 5);
  out[1] = __builtin_shufflevector(xyLow, zwLow, 2, 3, 6, 7);
  out[2] = __builtin_shufflevector(xyHigh, zwHigh, 0, 1, 4, 5);
  out[3] = __builtin_shufflevector(xyHigh, zwHigh, 2, 3, 6, 7);
}

}  // namespace radar
