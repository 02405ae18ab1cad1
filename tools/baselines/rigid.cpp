#include "baselines/rigid.h"

#include <algorithm>
#include <cmath>

namespace radar::tools {

namespace {

// Numbers that differ by roundings become one.
double coarse(double value) {
  int exponent = 0;
  const double mantissa = std::frexp(value, &exponent);
  return std::ldexp(std::round(std::ldexp(mantissa, 40)), exponent - 40);
}

}  // namespace

SplitPose split(const Transform& pose) {
  const auto& m = pose.m;
  SplitPose out;
  out.rigid.at = {m[3], m[7], m[11]};
  std::array<double, 3> scale{};
  for (size_t k = 0; k < 3; ++k) scale[k] = std::hypot(m[k], m[4 + k], m[8 + k]);
  const auto alongEachOther = [&](size_t i, size_t k) {
    const double dot = m[i] * m[k] + m[4 + i] * m[4 + k] + m[8 + i] * m[8 + k];
    return std::abs(dot) > 1e-12 * scale[i] * scale[k];
  };
  const double volume =
      m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
  if (volume <= 0 || alongEachOther(0, 1) || alongEachOther(1, 2) || alongEachOther(0, 2)) {
    out.bake = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    out.rigid.rotation = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    return out;
  }
  out.bake = {coarse(scale[0]), 0, 0, 0, coarse(scale[1]), 0, 0, 0, coarse(scale[2])};
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) out.rigid.rotation[3 * row + k] = m[4 * row + k] / scale[k];
  }
  return out;
}

std::vector<double> baked(const MeshData& mesh, const std::array<double, 9>& linear) {
  std::vector<double> positions(mesh.positions.size());
  for (size_t i = 0; i < positions.size(); i += 3) {
    const float* p = &mesh.positions[i];
    for (size_t row = 0; row < 3; ++row) {
      const double* r = &linear[3 * row];
      positions[i + row] = r[0] * p[0] + r[1] * p[1] + r[2] * p[2];
    }
  }
  return positions;
}

bool WorldBox::meets(const WorldBox& other) const {
  for (size_t k = 0; k < 3; ++k) {
    if (low[k] > other.high[k] || other.low[k] > high[k]) return false;
  }
  return true;
}

WorldBox WorldBox::swept(const std::array<double, 3>& displacement) const {
  WorldBox box = *this;
  for (size_t k = 0; k < 3; ++k) {
    box.low[k] += std::min(displacement[k], 0.0);
    box.high[k] += std::max(displacement[k], 0.0);
  }
  return box;
}

WorldBox boxOf(const MeshData& mesh, const Transform& pose) {
  WorldBox box;
  box.low.fill(INFINITY);
  box.high.fill(-INFINITY);
  for (size_t i = 0; i < mesh.positions.size(); i += 3) {
    const std::array<double, 3> p = transformPoint(pose, &mesh.positions[i]);
    for (size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(box.low[k], p[k]);
      box.high[k] = std::max(box.high[k], p[k]);
    }
  }
  return box;
}

std::array<double, 3> unitDirection(const Query& query) {
  const auto& v = query.direction;
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
