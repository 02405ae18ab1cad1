// Cutters of all kinds, and triangles for them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "radar/cutters.h"
#include "support/answer.h"
#include "support/real_points.h"
#include "workloads/random.h"

namespace radar::test {

using tools::Random;

/// A cutter by its numbers, and its lower surface by the formula of its kind.
struct CutterKind {
  const char* name;
  Real radius, corner, tip, angle, length;
  Cutter cutter;

  /// Height of the surface over the tip, `out` from the axis, up to the radius.
  Real height(Real out) const {
    const Real bend = std::max<Real>(out - (radius - corner), 0);
    const Real round = corner > 0 ? corner - std::sqrt(std::max<Real>(corner * corner - bend * bend, 0)) : 0;
    if (angle == 0) return round;
    const Real touch = tip * std::cos(angle);  // of a taper's ball
    if (corner == 0) return std::max<Real>(out - tip, 0) / std::tan(angle);
    return out < touch ? tip - std::sqrt(tip * tip - out * out)
                       : tip - tip * std::sin(angle) + (out - touch) / std::tan(angle);
  }
};

inline constexpr int kCutterKinds = 6;

/// One of kCutterKinds. `angle` and `tip` are of cones and tapers, whose `length` begins where the cone ends.
inline CutterKind cutterOf(int which, double r, double corner, double angle, double tip, double length) {
  const double whole = length + r / std::tan(angle);
  switch (which) {
    case 0:
      return {"flat", r, 0, 0, 0, length, flatCutter(r, length)};
    case 1:
      return {"ball", r, r, 0, 0, length, ballCutter(r, length)};
    case 2:
      return {"bull nose", r, corner, 0, 0, length, bullNoseCutter(r, corner, length)};
    case 3:
      return {"cone", r, 0, 0, angle, whole, coneCutter(r, angle, whole)};
    case 4:
      return {"cone with a flat tip", r, 0, tip, angle, whole, coneCutter(r, angle, whole, tip)};
    default:
      return {"taper", r, tip, tip, angle, whole, taperCutter(r, angle, tip, whole)};
  }
}
inline CutterKind cutterOf(int which, Random& random) {
  const double r = random.uniform(0.3, 3), length = r + random.uniform(4, 9), corner = r * random.uniform(0.05, 0.95);
  const double angle = random.uniform(0.15, 1.3), tip = r * random.uniform(0, 0.6) * std::cos(angle);
  return cutterOf(which, r, corner, angle, tip, length);
}

/// Where a concave function is greatest.
template <class Function>
Real whereGreatest(const Function& f, Real from, Real to) {
  for (int i = 0; i < 60; ++i) {
    const Real p = from + (to - from) * 0.49L, q = from + (to - from) * 0.51L;
    if (f(p) < f(q)) {
      from = p;
    } else {
      to = q;
    }
  }
  return 0.5L * (from + to);
}

inline std::vector<uint32_t> oneTriangle() {
  return {0, 1, 2};
}

inline std::vector<float> cornersNear(Random& random, double spread, uint64_t seed) {
  std::vector<float> out;
  for (int i = 0; i < 3; ++i) {
    for (const double x : random.inCube(spread)) out.push_back(static_cast<float>(x));
  }
  if (seed % 7 == 1) out[2] = out[5] = out[8];          // level
  if (seed % 7 == 2) out[3] = out[0], out[4] = out[1];  // an upright edge
  if (seed % 7 == 3) out[5] = out[2];                   // a level edge
  if (seed % 7 == 4) {                                  // upright
    out[6] = 2 * out[3] - out[0];
    out[7] = 2 * out[4] - out[1];
  }
  return out;
}

}  // namespace radar::test
