// Several floats or doubles at a time, with the vector extension of GCC and Clang. Four, which needs only the
// instructions that every 64-bit processor has, unless the file that includes this says how many.
#pragma once

#include <cstdint>
#include <cstring>
#include <utility>

#ifdef __SSE2__
#include <immintrin.h>
#endif

#ifndef RADAR_LANES
#define RADAR_LANES 4
#define RADAR_WIDTH lanes4
#endif

namespace radar {

// What depends on the number of lanes is another thing for each: a program may have several.
inline namespace RADAR_WIDTH {

inline constexpr int kLanes = RADAR_LANES;

using Floats = float __attribute__((vector_size(4 * kLanes)));
using HalfOfDoubles = double __attribute__((vector_size(4 * kLanes)));
using FourFloats = float __attribute__((vector_size(16)));

/// The signs of a vector's numbers, one bit each.
template <class Vector>
unsigned signsOf(const Vector& x) {
#if RADAR_LANES == 8
  if constexpr (sizeof(x[0]) == sizeof(float)) {
    return static_cast<unsigned>(__builtin_ia32_movmskps256(Floats(x)));
  } else {
    return static_cast<unsigned>(__builtin_ia32_movmskpd256(HalfOfDoubles(x)));
  }
#elif defined(__SSE2__)
  if constexpr (sizeof(x[0]) == sizeof(float)) {
    return static_cast<unsigned>(__builtin_ia32_movmskps(Floats(x)));
  } else {
    return static_cast<unsigned>(__builtin_ia32_movmskpd(HalfOfDoubles(x)));
  }
#else
  unsigned bits = 0;
  for (unsigned i = 0; i < sizeof(x) / sizeof(x[0]); ++i) bits |= unsigned{x[i] < 0} << i;
  return bits;
#endif
}

/// A vector's numbers as doubles, and those doubles rounded to nearest. By instructions for it: GCC makes conversions
/// of vectors whose lengths differ one by one.
inline void widen(const Floats& x, HalfOfDoubles& low, HalfOfDoubles& high) {
#if RADAR_LANES == 8
  low = _mm256_cvtps_pd(_mm256_castps256_ps128(x));
  high = _mm256_cvtps_pd(_mm256_extractf128_ps(x, 1));
#elif defined(__SSE2__)
  low = _mm_cvtps_pd(x);
  high = _mm_cvtps_pd(_mm_movehl_ps(x, x));
#else
  for (int i = 0; i < kLanes / 2; ++i) {
    low[i] = x[i];
    high[i] = x[kLanes / 2 + i];
  }
#endif
}
inline Floats narrowed(const HalfOfDoubles& low, const HalfOfDoubles& high) {
#if RADAR_LANES == 8
  return _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
#elif defined(__SSE2__)
  return _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
#else
  Floats out;
  for (int i = 0; i < kLanes / 2; ++i) {
    out[i] = static_cast<float>(low[i]);
    out[kLanes / 2 + i] = static_cast<float>(high[i]);
  }
  return out;
#endif
}

/// `min`, `max` and `select` compare x with y; if either is NaN they return the second choice, y or q.
template <class Real>
struct Lanes;

template <>
struct Lanes<float> {
  Floats v;
  Lanes() = default;
  Lanes(float x) : v(x - Floats{}) {}                                 // NOLINT: in all lanes
  Lanes(Floats x) : v(x) {}                                           // NOLINT
  Lanes(const float (&x)[kLanes]) { std::memcpy(&v, x, sizeof(v)); }  // NOLINT
  float operator[](int i) const { return v[i]; }
  Floats floats() const { return v; }

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
  friend Lanes abs(const Lanes& x) { return Floats(Bits(x.v) & ~kSign); }
  /// x, with its sign changed where y is below 0.
  friend Lanes withSignOf(const Lanes& x, const Lanes& y) { return Floats(Bits(x.v) ^ (Bits(y.v) & kSign)); }

 private:
  using Bits = uint32_t __attribute__((vector_size(4 * kLanes)));
  static constexpr uint32_t kSign = 0x80000000u;
};

template <>
struct Lanes<double> {
  HalfOfDoubles low, high;
  Lanes() = default;
  Lanes(double x) : low(x - HalfOfDoubles{}), high(low) {}  // NOLINT: in all lanes
  Lanes(HalfOfDoubles x, HalfOfDoubles y) : low(x), high(y) {}
  Lanes(const double (&x)[kLanes]) {  // NOLINT
    std::memcpy(&low, x, sizeof(low));
    std::memcpy(&high, x + kLanes / 2, sizeof(high));
  }
  Lanes(Floats x) { widen(x, low, high); }  // NOLINT
  double operator[](int i) const { return i < kLanes / 2 ? low[i] : high[i - kLanes / 2]; }
  /// Rounded to nearest.
  Floats floats() const { return narrowed(low, high); }

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
    return signsOf(x.low > y.low) | signsOf(x.high > y.high) << (kLanes / 2);
  }
  friend Lanes abs(const Lanes& x) {
    return {HalfOfDoubles(Bits(x.low) & ~kSign), HalfOfDoubles(Bits(x.high) & ~kSign)};
  }
  friend Lanes withSignOf(const Lanes& x, const Lanes& y) {
    return {HalfOfDoubles(Bits(x.low) ^ (Bits(y.low) & kSign)), HalfOfDoubles(Bits(x.high) ^ (Bits(y.high) & kSign))};
  }

 private:
  using Bits = uint64_t __attribute__((vector_size(4 * kLanes)));
  static constexpr uint64_t kSign = uint64_t{1} << 63;
};

template <class Real>
using LaneVec = Lanes<Real>[3];

template <class Real>
Lanes<Real> dot(const LaneVec<Real>& p, const LaneVec<Real>& q) {
  return p[0] * q[0] + p[1] * q[1] + p[2] * q[2];
}

template <class Real>
[[gnu::always_inline]] inline void cross(const LaneVec<Real>& p, const LaneVec<Real>& q, LaneVec<Real>& out) {
  out[0] = p[1] * q[2] - p[2] * q[1];
  out[1] = p[2] * q[0] - p[0] * q[2];
  out[2] = p[0] * q[1] - p[1] * q[0];
}

/// In each lane, that of x or, from kLanes on, of y which `from` names: a constant function of the lane.
template <class Vector, class From>
Vector picked(const Vector& x, const Vector& y, From) {
  return [&]<int... lanes>(std::integer_sequence<int, lanes...>) {
    return __builtin_shufflevector(x, y, From{}(lanes)...);
  }
  (std::make_integer_sequence<int, kLanes>());
}

/// Four lanes of each.
inline Floats joined(const FourFloats (&fours)[kLanes / 4]) {
#if RADAR_LANES == 8
  return __builtin_shufflevector(fours[0], fours[1], 0, 1, 2, 3, 4, 5, 6, 7);
#else
  return fours[0];
#endif
}

/// Each number in four lanes.
inline Lanes<float> inFours(const float (&x)[kLanes / 4]) {
  FourFloats fours[kLanes / 4];
  for (int i = 0; i < kLanes / 4; ++i) fours[i] = x[i] - FourFloats{};
  return joined(fours);
}
inline Lanes<double> inFours(const double (&x)[kLanes / 4]) {
  return {x[0] - HalfOfDoubles{}, x[kLanes / 4 - 1] - HalfOfDoubles{}};
}

/// The i-th of each four lanes of x, twice, then of y; and x y x y.
template <int i>
Floats twiceEach(const Floats& x, const Floats& y) {
  return picked(x, y, [](int lane) { return lane / 4 * 4 + i + (lane % 4 < 2 ? 0 : kLanes); });
}
template <int i>
Floats alternating(const Floats& x, const Floats& y) {
  return picked(x, y, [](int lane) { return lane / 4 * 4 + i + (lane % 2 == 0 ? 0 : kLanes); });
}

/// Of four floats per lane, the i-th in out[i]; rows[i] holds those of lane i, and of lane 4 + i.
inline void transpose(const Floats (&rows)[4], Floats (&out)[4]) {
  const auto low = [](int lane) { return lane / 4 * 4 + lane % 4 / 2 + (lane % 2 == 0 ? 0 : kLanes); };
  const auto high = [](int lane) { return lane / 4 * 4 + 2 + lane % 4 / 2 + (lane % 2 == 0 ? 0 : kLanes); };
  const auto first = [](int lane) { return lane / 4 * 4 + lane % 2 + (lane % 4 < 2 ? 0 : kLanes); };
  const auto second = [](int lane) { return lane / 4 * 4 + 2 + lane % 2 + (lane % 4 < 2 ? 0 : kLanes); };
  const auto& [x, y, z, w] = rows;
  const Floats xyLow = picked(x, y, low), xyHigh = picked(x, y, high);
  const Floats zwLow = picked(z, w, low), zwHigh = picked(z, w, high);
  out[0] = picked(xyLow, zwLow, first);
  out[1] = picked(xyLow, zwLow, second);
  out[2] = picked(xyHigh, zwHigh, first);
  out[3] = picked(xyHigh, zwHigh, second);
}

}  // namespace RADAR_WIDTH

}  // namespace radar
