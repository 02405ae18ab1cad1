// Bounds the times at which nodes of two meshes' trees can meet, for as many pairs as there are lanes, by the slabs
// along their boxes' axes and along their mean normals. docs/method.md derives the error bounds.
#pragma once

#include "cpu/pair_motion.h"
#include "math/lanes.h"

namespace radar::cpu {

inline namespace RADAR_WIDTH {

/// Bound on the relative rounding error of an operation in a lane.
template <class Real>
inline constexpr double kRounding = sizeof(Real) == sizeof(float) ? 0x1p-24 : kUnit;

/// Lower speeds are replaced by this one. The change is no larger than the rounding.
template <class Real>
inline constexpr double kLeastSpeed = sizeof(Real) == sizeof(float) ? 0x1p-20 : 0x1p-40;

/// Products of three larger numbers might overflow.
template <class Real>
inline constexpr double kMostMagnitude = sizeof(Real) == sizeof(float) ? 0x1p30 : 0x1p200;

/// Time bounds for contact of each lane's pair; a pair with from > to does not meet.
template <class Real>
struct Times {
  Lanes<Real> from, to;
};

using NodeLanes = std::array<const gpu::MeshNode*, kLanes>;

/// Loads floats 4 * place to 4 * place + 3 of each node; out[i] has the i-th of them, one lane per node.
inline void load(const NodeLanes& nodes, int place, Floats (&out)[4]) {
  static_assert(sizeof(gpu::MeshNode) == 3 * sizeof(FourFloats));
  Floats rows[4];
  for (int i = 0; i < 4; ++i) {
    FourFloats fours[kLanes / 4];
    for (int k = 0; k < kLanes / 4; ++k) {
      const char* const node = reinterpret_cast<const char*>(nodes[4 * k + i]);
      std::memcpy(&fours[k], node + place * sizeof(FourFloats), sizeof(FourFloats));
    }
    rows[i] = joined(fours);
  }
  transpose(rows, out);
}

/// Tests nodes of a mesh A, in motion, and of a mesh B.
template <class Real>
class NodeTest {
 public:
  /// `fromA`: B in A's frame; `fromB`: A in B's frame.
  NodeTest(const RelativePlacement& fromA, const RelativePlacement& fromB) : alongA_(fromA), alongB_(fromB) {}

  /// In the pair's unit of time; `from` may be before the start.
  Times<Real> operator()(const NodeLanes& a, const NodeLanes& b) const;

 private:
  /// A RelativePlacement, divided by the speed along each axis: a vertex q of the frame's own mesh and p of the other
  /// are level at time rate q - matrix p - offset, up to slack.
  struct Axes {
    LaneVec<Real> matrix[3], matrixSize[3];
    LaneVec<Real> speed, rate, rateSize, offset;
    LaneVec<Real> slack, normalSlack;
    bool complete = true;  ///< no axis was left out

    explicit Axes(const RelativePlacement& relative);
  };
  struct Nodes;

  static void cutByBox(Times<Real>& times, const Nodes& own, const Nodes& other, const Axes& axes);
  static void cutByNormal(Times<Real>& times, const Nodes& own, const Nodes& other, const Axes& axes);

  Axes alongA_, alongB_;
};

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
