// Vectors and rotations that shapes are placed by, the same bits on every platform.
#pragma once

#include <array>

#include "workloads/random.h"

namespace radar::tools {

using Rotation = std::array<double, 9>;  ///< row-major

inline constexpr Vec3 kFull{1, 1, 1};  ///< a scale
inline constexpr Rotation kUpright{1, 0, 0, 0, 1, 0, 0, 0, 1};
inline constexpr Rotation kOnEdge{1, 0, 0, 0, 0, -1, 0, 1, 0};  ///< y upwards

Vec3 scaled(const Vec3& v, double factor);
Vec3 turned(const Rotation& rotation, const Vec3& v);
Rotation product(const Rotation& p, const Rotation& q);

/// 10^least to 10^most, whole powers alike.
double magnitude(Random& random, int least, int most);
/// Whole numbers of -limit to limit.
Vec3 wholeVector(Random& random, uint32_t limit);
/// One of the six unit vectors.
Vec3 axis(Random& random);
/// About a random axis, by up to about half of `angle`.
Rotation slightRotation(Random& random, double angle);

/// By quarter turns: exact.
Rotation quarterTurns(Random& random);

}  // namespace radar::tools
