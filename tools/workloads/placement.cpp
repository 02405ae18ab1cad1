#include "workloads/placement.h"

#include <cmath>

namespace radar::tools {

double magnitude(Random& random, int least, int most) {
  return powerOfTen(least + static_cast<int>(random.below(static_cast<uint32_t>(most - least + 1))));
}

Vec3 scaled(const Vec3& v, double factor) {
  return {factor * v[0], factor * v[1], factor * v[2]};
}

Vec3 wholeVector(Random& random, uint32_t limit) {
  Vec3 v{};
  for (double& value : v) value = double(random.below(2 * limit + 1)) - limit;
  return v;
}

Vec3 axis(Random& random) {
  Vec3 v{};
  v[random.below(3)] = random.oneIn(2) ? 1 : -1;
  return v;
}

Vec3 turned(const Rotation& rotation, const Vec3& v) {
  Vec3 out{};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) out[row] += rotation[3 * row + k] * v[k];
  }
  return out;
}

Rotation product(const Rotation& p, const Rotation& q) {
  Rotation out{};
  for (size_t i = 0; i < 9; ++i) {
    for (size_t k = 0; k < 3; ++k) out[i] += p[i / 3 * 3 + k] * q[3 * k + i % 3];
  }
  return out;
}

Rotation slightRotation(Random& random, double angle) {
  const double half = 0.5 * angle;
  const Vec3 v = random.inBox({-half, -half, -half}, {half, half, half});
  const double w = 1 / std::sqrt(1 + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), x = v[0] * w, y = v[1] * w, z = v[2] * w;
  return {1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
          2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
          2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
}

Rotation quarterTurns(Random& random) {
  Rotation rotation = kUpright;
  for (uint32_t i = random.below(4); i > 0; --i) rotation = product({0, -1, 0, 1, 0, 0, 0, 0, 1}, rotation);
  for (uint32_t i = random.below(4); i > 0; --i) rotation = product({0, 0, 1, 0, 1, 0, -1, 0, 0}, rotation);
  for (uint32_t i = random.below(4); i > 0; --i) rotation = product(kOnEdge, rotation);
  return rotation;
}

}  // namespace radar::tools
