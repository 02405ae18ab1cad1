// Random numbers that are the same on every platform: std::mt19937_64 is specified to the bit, the distributions of the
// standard library are not, nor are sin and cos. Only +, -, *, / and sqrt of doubles follow here.
#pragma once

#include <array>
#include <cstdint>
#include <random>

#include "radar/radar.h"

namespace radar::tools {

using Vec3 = std::array<double, 3>;

class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high);  ///< in [low, high)
  uint32_t below(uint32_t limit);           ///< in 0 .. limit - 1; limit > 0
  bool oneIn(uint32_t n) { return below(n) == 0; }
  Vec3 inBox(const Vec3& low, const Vec3& high);  ///< a point
  Vec3 direction();                               ///< on the unit sphere
  std::array<double, 9> rotation();               ///< row-major, uniform over all rotations

 private:
  std::mt19937_64 bits_;
};

/// World = rotation * diag(scale) * p + at.
Transform makePose(const std::array<double, 9>& rotation, const Vec3& scale, const Vec3& at);

/// Turned, scaled by 0.3 to 2 per axis, sometimes sheared and sometimes mirrored.
Transform randomAffine(Random& random, const Vec3& at);

/// 10^exponent, the same bits everywhere.
double powerOfTen(int exponent);

/// {cos, sin} of 2 pi k / n, the same bits everywhere, exact at quarter turns.
std::array<double, 2> circlePoint(uint32_t k, uint32_t n);

}  // namespace radar::tools
