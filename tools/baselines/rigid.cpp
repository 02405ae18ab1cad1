#include "baselines/rigid.h"

#include <algorithm>

namespace radar::tools {

namespace {

// Makes numbers that differ by roundings equal.
double coarse(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 40)), exponent - 40);
}

}  // namespace

RigidPose rigidPose(const Transform& pose) {
  const Rotation linear = linearPart(pose);
  const auto column = [&](size_t k) { return Vec3{linear[k], linear[3 + k], linear[6 + k]}; };
  RigidPose out{kUpright, {pose.m[3], pose.m[7], pose.m[11]}, linear};
  Vec3 scale{};
  for (size_t k = 0; k < 3; ++k) scale[k] = std::hypot(linear[k], linear[3 + k], linear[6 + k]);
  const auto alongEachOther = [&](size_t i, size_t k) {
    return std::abs(dot(column(i), column(k))) > 1e-12 * scale[i] * scale[k];
  };
  const double volume = linear[0] * (linear[4] * linear[8] - linear[5] * linear[7]) -
                        linear[1] * (linear[3] * linear[8] - linear[5] * linear[6]) +
                        linear[2] * (linear[3] * linear[7] - linear[4] * linear[6]);
  if (volume <= 0 || alongEachOther(0, 1) || alongEachOther(1, 2) || alongEachOther(0, 2)) return out;
  out.bake = {coarse(scale[0]), 0, 0, 0, coarse(scale[1]), 0, 0, 0, coarse(scale[2])};
  for (size_t i = 0; i < 9; ++i) out.rotation[i] = linear[i] / scale[i % 3];
  return out;
}

std::vector<double> baked(const MeshData& mesh, const Rotation& linear) {
  std::vector<double> positions;
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const float* p = &mesh.positions[i];
    const Vec3 moved = turned(linear, {p[0], p[1], p[2]});
    positions.insert(positions.end(), moved.begin(), moved.end());
  }
  return positions;
}

bool meet(const Bounds& a, const Bounds& b) {
  for (size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

Bounds swept(Bounds bounds, const Vec3& displacement) {
  const Bounds start = bounds;
  bounds.add(start.low + displacement);
  bounds.add(start.high + displacement);
  return bounds;
}

Vec3 unitDirection(const Query& query) {
  const Vec3& v = query.direction;
  const double length = std::hypot(v[0], v[1], v[2]);
  return {v[0] / length, v[1] / length, v[2] / length};
}

bool isExcluded(const Query& query, uint32_t object) {
  return std::find(query.exclude.begin(), query.exclude.end(), object) != query.exclude.end();
}

std::optional<double> steppedContact(double distance, uint32_t steps, const std::function<bool(double)>& meets) {
  constexpr int kBisections = 20;
  if (meets(0)) return 0;
  double apart = 0;
  for (uint32_t step = 1; step <= steps && distance > 0; ++step) {
    double together = distance * step / steps;
    if (!meets(together)) {
      apart = together;
      continue;
    }
    for (int i = 0; i < kBisections; ++i) {
      const double middle = 0.5 * (apart + together);
      (meets(middle) ? together : apart) = middle;
    }
    return together;
  }
  return std::nullopt;
}

}  // namespace radar::tools
