// The frame of one query: its origin at the sensor, three axes across the motion, 60 degrees apart, and the motion
// itself. Boxes become prisms over a hexagon there: the third axis across costs nothing in four lanes of SIMD and cuts
// the corners that a rectangle would leave.
//
// All of this only sorts out; what it keeps is decided by radar/exact. So every bound here is widened by what rounding
// can have done to it (docs/method.md), and nothing is ever dropped wrongly.
#pragma once

#include <Eigen/Core>
#include <limits>

#include "exact/contact.h"
#include "radar/radar.h"

namespace radar::reference {

using Lanes = Eigen::Array4d;  ///< three across, then along the motion
using exact::Vec;

inline constexpr double kUnit = 0x1p-53;
inline constexpr double kNever = std::numeric_limits<double>::infinity();

struct View {
  Vec origin;
  std::array<Lanes, 3> axes;  ///< axes[k]: component k, in the world, of each lane's axis

  View(const Vec& sensor, const Vec& direction);

  Lanes turn(const Vec& v) const { return axes[0] * v[0] + axes[1] * v[1] + axes[2] * v[2]; }
};

struct LaneBox {
  Lanes centre, half;
};

/// Lower bound on the distance at which anything of `a` meets anything of `b`; kNever if nothing does at 0 or later.
inline double reach(const LaneBox& a, const LaneBox& b) {
  const Lanes gap = b.centre - a.centre, both = a.half + b.half;
  const Lanes apart = gap.abs() - both;
  if (apart[0] > 0 || apart[1] > 0 || apart[2] > 0 || gap[3] + both[3] < 0) return kNever;
  return gap[3] - both[3];
}

/// Takes axis-aligned boxes of a placed mesh, or of the world, to lane boxes that hold every placed vertex.
class Turned {
 public:
  /// `extent[k]`: the largest |coordinate k| in the boxes.
  Turned(const View& view, const Pose& worldFromLocal, const Vec& extent);

  template <class Node>
  LaneBox box(const Node& node) const {
    const double x = 0.5 * (double(node.lo[0]) + node.hi[0]), hx = 0.5 * (double(node.hi[0]) - node.lo[0]);
    const double y = 0.5 * (double(node.lo[1]) + node.hi[1]), hy = 0.5 * (double(node.hi[1]) - node.lo[1]);
    const double z = 0.5 * (double(node.lo[2]) + node.hi[2]), hz = 0.5 * (double(node.hi[2]) - node.lo[2]);
    return {offset_ + column_[0] * x + column_[1] * y + column_[2] * z,
            slack_ + size_[0] * hx + size_[1] * hy + size_[2] * hz};
  }

 private:
  std::array<Lanes, 3> column_, size_;
  Lanes offset_, slack_;
};

}  // namespace radar::reference
