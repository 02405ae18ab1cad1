#include "reference/view.h"

#include <algorithm>
#include <cmath>

namespace radar::reference {

namespace {

Vec normalized(Vec v) {
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  for (double& c : v) c /= largest;
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (double& c : v) c /= length;
  return v;
}

}  // namespace

View::View(const Vec& sensor, const Vec& direction) : origin(sensor) {
  const Vec w = normalized(direction);
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(w[k]) < std::abs(w[least])) least = k;
  }
  const int i = (least + 1) % 3, j = (least + 2) % 3;
  Vec u{};
  u[i] = -w[j];
  u[j] = w[i];
  u = normalized(u);
  const Vec v{w[1] * u[2] - w[2] * u[1], w[2] * u[0] - w[0] * u[2], w[0] * u[1] - w[1] * u[0]};
  constexpr double kSin60 = 0.86602540378443864676;
  for (int k = 0; k < 3; ++k) axes[k] = Lanes(u[k], 0.5 * u[k] + kSin60 * v[k], 0.5 * u[k] - kSin60 * v[k], w[k]);
}

Turned::Turned(const View& view, const Pose& worldFromLocal, const Vec& extent) {
  const auto& m = worldFromLocal.m;
  double magnitude = 0;
  for (int k = 0; k < 3; ++k) {
    column_[k] = view.turn({m[k], m[4 + k], m[8 + k]});
    size_[k] = column_[k].abs();
    magnitude += (std::abs(m[k]) + std::abs(m[4 + k]) + std::abs(m[8 + k])) * extent[k];
    magnitude += std::abs(m[4 * k + 3]) + std::abs(view.origin[k]);
  }
  offset_ = view.turn({m[3] - view.origin[0], m[7] - view.origin[1], m[11] - view.origin[2]});
  // Placing, turning and adding lose less than 32 roundings of the largest magnitude that occurs.
  slack_ = Lanes::Constant(48 * kUnit * magnitude);
}

}  // namespace radar::reference
