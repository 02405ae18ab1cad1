#include "workloads/random.h"

#include <cstdlib>
#include <utility>

namespace radar::tools {

namespace {

/// Taylor series for 0 <= x <= pi/4, summed from the smallest term.
std::array<double, 2> cosSin(double x) {
  const double y = x * x;
  double cosine = 0, sine = 0;
  for (int k = 20; k > 0; k -= 2) {
    cosine = (1 - cosine) * y / (k * (k - 1.0));
    sine = (1 - sine) * y / (k * (k + 1.0));
  }
  return {1 - cosine, x * (1 - sine)};
}

/// Of the quaternion w + xi + yj + zk; s: 2 over the square of its length.
Rotation fromQuaternion(double w, double x, double y, double z, double s) {
  return {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
          s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
          s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
}

}  // namespace

double Random::uniform(double low, double high) {
  const double unit = static_cast<double>(bits_() >> 11) * 0x1p-53;
  return low + (high - low) * unit;
}

uint32_t Random::below(uint32_t limit) {
  return static_cast<uint32_t>((bits_() >> 32) * limit >> 32);
}

Vec3 Random::inBox(const Vec3& low, const Vec3& high) {
  return {uniform(low[0], high[0]), uniform(low[1], high[1]), uniform(low[2], high[2])};
}

Vec3 Random::direction() {
  while (true) {
    const Vec3 p = inCube(1);
    const double square = dot(p, p);
    if (square > 1 || square < 1e-4) continue;
    const double length = std::sqrt(square);
    return {p[0] / length, p[1] / length, p[2] / length};
  }
}

Rotation Random::rotation() {
  while (true) {
    const double w = uniform(-1, 1), x = uniform(-1, 1), y = uniform(-1, 1), z = uniform(-1, 1);
    const double square = w * w + x * x + y * y + z * z;
    if (square <= 1 && square >= 1e-4) return fromQuaternion(w, x, y, z, 2 / square);
  }
}

Rotation Random::slightRotation(double most) {
  const Vec3 v = inCube(0.5 * most);
  const double w = 1 / std::sqrt(1 + v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  return fromQuaternion(w, v[0] * w, v[1] * w, v[2] * w, 2);
}

Rotation Random::quarterTurns() {
  Rotation rotation = kUpright;
  for (const Rotation& turn : {Rotation{0, -1, 0, 1, 0, 0, 0, 0, 1}, Rotation{0, 0, 1, 0, 1, 0, -1, 0, 0}, kOnEdge}) {
    for (uint32_t i = below(4); i > 0; --i) rotation = product(turn, rotation);
  }
  return rotation;
}

Vec3 Random::wholeVector(uint32_t limit) {
  Vec3 v{};
  for (double& value : v) value = double(below(2 * limit + 1)) - limit;
  return v;
}

Vec3 Random::axis() {
  Vec3 v{};
  v[below(3)] = oneIn(2) ? 1 : -1;
  return v;
}

double Random::magnitude(int least, int most) {
  return powerOfTen(least + static_cast<int>(below(static_cast<uint32_t>(most - least + 1))));
}

Transform Random::affine(const Vec3& at) {
  const Rotation turn = rotation();
  const Vec3 scale = inBox({0.3, 0.3, 0.3}, {2, 2, 2});
  Transform pose = makePose(turn, {oneIn(2) ? scale[0] : -scale[0], scale[1], scale[2]}, at);
  if (oneIn(2)) {
    const double shear = uniform(-0.5, 0.5);
    for (size_t row = 0; row < 3; ++row) pose.m[4 * row + 1] += shear * pose.m[4 * row];
  }
  return pose;
}

std::array<double, 2> circlePoint(uint32_t k, uint32_t n) {
  constexpr double kPi = 3.14159265358979323846;
  // Integers fold the angle into the first eighth of a turn, so that symmetric points are symmetric to the bit.
  const uint64_t eighths = 8ull * (k % n);
  const uint64_t octant = eighths / n;
  const uint64_t rest = octant % 2 == 0 ? eighths % n : n - eighths % n;
  auto [c, s] = cosSin(kPi / 4 * (static_cast<double>(rest) / n));
  if (rest == n) c = s = std::sqrt(0.5);
  if (octant % 4 == 1 || octant % 4 == 2) std::swap(c, s);
  if (octant >= 2 && octant < 6) c = -c;
  if (octant >= 4) s = -s;
  return {c, s};
}

double powerOfTen(int exponent) {
  double power = 1;
  for (int i = 0; i < std::abs(exponent); ++i) power *= 10;
  return exponent < 0 ? 1 / power : power;
}

}  // namespace radar::tools
