// The truth about motions of solids that fill cells of a grid: how far one can move until its interior would meet that
// of another.
#pragma once

#include "exact_oracle.h"
#include "workloads/voxels.h"

namespace voxels {

/// The least parameter s >= 0 at which the interior of `a`, moved by s * direction for integer components, begins to
/// meet that of `b`; -1 if it never does.
inline oracle::Rational begins(const radar::tools::Solid& a, const radar::tools::Solid& b,
                               const std::array<double, 3>& direction) {
  using oracle::Rational;
  Rational best = -1;
  for (const radar::tools::Voxel& p : a) {
    for (const radar::tools::Voxel& q : b) {
      Rational from = 0, to = 1'000'000;
      bool meets = true;
      for (int k = 0; k < 3; ++k) {
        const int gap = q[k] - p[k], d = static_cast<int>(direction[k]);
        if (d == 0) {
          meets = meets && gap == 0;
          continue;
        }
        // Open cubes overlap along this axis for |gap - s d| < 1.
        const Rational one = Rational(gap - 1) / d, other = Rational(gap + 1) / d;
        from = std::max(from, std::min(one, other));
        to = std::min(to, std::max(one, other));
      }
      if (meets && from < to && (best < 0 || from < best)) best = from;
    }
  }
  return best;
}

}  // namespace voxels
