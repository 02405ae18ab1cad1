// Random numbers that are the same on every platform: std::mt19937_64 is specified to the bit, the distributions of the
// standard library are not, nor are sin and cos. Only +, -, *, / and sqrt of doubles follow here.
#pragma once

#include <cstdint>
#include <random>

#include "workloads/vectors.h"

namespace radar::tools {

class Random {
 public:
  explicit Random(uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high);  ///< in [low, high)
  uint32_t below(uint32_t limit);           ///< in 0 .. limit - 1; limit > 0
  bool oneIn(uint32_t n) { return below(n) == 0; }
  Vec3 inBox(const Vec3& low, const Vec3& high);  ///< a point
  Vec3 inCube(double reach) { return inBox({-reach, -reach, -reach}, {reach, reach, reach}); }
  Vec3 direction();                      ///< on the unit sphere
  Rotation rotation();                   ///< uniform over all rotations
  Rotation slightRotation(double most);  ///< about a random axis, by up to about half of `most`
  Rotation quarterTurns();               ///< exact
  Vec3 wholeVector(uint32_t limit);      ///< whole numbers of -limit to limit
  Vec3 axis();                           ///< one of the six unit vectors
  /// 10^least to 10^most, whole powers alike.
  double magnitude(int least, int most);
  /// Turned, scaled by 0.3 to 2 per axis, sometimes sheared and sometimes mirrored.
  Transform affine(const Vec3& at);

 private:
  std::mt19937_64 bits_;
};

/// 10^exponent, the same bits everywhere.
double powerOfTen(int exponent);

/// {cos, sin} of 2 pi k / n, the same bits everywhere, exact at quarter turns.
std::array<double, 2> circlePoint(uint32_t k, uint32_t n);

}  // namespace radar::tools
