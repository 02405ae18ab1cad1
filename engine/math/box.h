// Axis-aligned boxes in double precision.
#pragma once

#include <algorithm>

#include "math/vector.h"

namespace radar {

/// Empty while lo > hi.
struct Box {
  Vector lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  void add(const Vector& p) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], p[k]);
      hi[k] = std::max(hi[k], p[k]);
    }
  }
  /// An empty box changes nothing.
  void merge(const Box& b) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], b.lo[k]);
      hi[k] = std::max(hi[k], b.hi[k]);
    }
  }
  double middle(int axis) const { return 0.5 * lo[axis] + 0.5 * hi[axis]; }
};

/// Whether two boxes, one of them widened by `slack`, have a point in common.
inline bool overlap(const Box& a, const Box& b, double slack) {
  for (int k = 0; k < 3; ++k) {
    if (a.lo[k] > b.hi[k] + slack || a.hi[k] < b.lo[k] - slack) return false;
  }
  return true;
}

}  // namespace radar
