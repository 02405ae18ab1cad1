#include "workloads/clearance.h"

#include <algorithm>
#include <cmath>

namespace radar::tools {

int64_t Clearance::cellOf(double coordinate) const {
  return static_cast<int64_t>(std::floor(coordinate / cell_));
}

uint64_t Clearance::keyOf(int64_t x, int64_t y, int64_t z) {
  constexpr int64_t kHalf = 1 << 20;  // 21 bits an axis
  return uint64_t(x + kHalf) << 42 | uint64_t(y + kHalf) << 21 | uint64_t(z + kHalf);
}

void Clearance::add(const Vec3& centre, double radius) {
  largest_ = std::max(largest_, radius);
  cells_[keyOf(cellOf(centre[0]), cellOf(centre[1]), cellOf(centre[2]))].push_back({centre, radius});
}

bool Clearance::isFree(const Vec3& centre, double radius) const {
  const double reach = radius + largest_;
  for (int64_t x = cellOf(centre[0] - reach); x <= cellOf(centre[0] + reach); ++x) {
    for (int64_t y = cellOf(centre[1] - reach); y <= cellOf(centre[1] + reach); ++y) {
      for (int64_t z = cellOf(centre[2] - reach); z <= cellOf(centre[2] + reach); ++z) {
        const auto found = cells_.find(keyOf(x, y, z));
        if (found == cells_.end()) continue;
        for (const Sphere& sphere : found->second) {
          if (spheresTouch(centre, radius, sphere.centre, sphere.radius)) return false;
        }
      }
    }
  }
  return true;
}

bool spheresTouch(const Vec3& a, double radiusA, const Vec3& b, double radiusB) {
  const double x = a[0] - b[0], y = a[1] - b[1], z = a[2] - b[2], reach = radiusA + radiusB;
  return x * x + y * y + z * z <= reach * reach;
}

}  // namespace radar::tools
