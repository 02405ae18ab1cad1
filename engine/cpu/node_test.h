// When nodes of two meshes' trees can meet: four pairs of nodes at a time, by the slabs along their boxes' axes and
// along their mean normals. The error bounds are derived in docs/method.md.
#pragma once

#include "cpu/lanes.h"
#include "cpu/pair_motion.h"

namespace radar::cpu {

/// What a number of a lane loses in an operation, at most, relative to the result.
template <class Real>
inline constexpr double kRounding = sizeof(Real) == sizeof(float) ? 0x1p-24 : kUnit;

/// Speeds below it are taken for it. That moves nothing by more than it is rounded by anyway.
template <class Real>
inline constexpr double kLeastSpeed = sizeof(Real) == sizeof(float) ? 0x1p-20 : 0x1p-40;

/// Of larger numbers products of three might overflow.
template <class Real>
inline constexpr double kMostMagnitude = sizeof(Real) == sizeof(float) ? 0x1p30 : 0x1p200;

/// Bounds on when each of four pairs can meet; not where from > to.
template <class Real>
struct Times {
  Lanes<Real> from, to;
};

using FourNodes = std::array<const gpu::MeshNode*, 4>;

/// Tests nodes of a mesh A, in motion, and of a mesh B.
template <class Real>
class NodeTest {
 public:
  /// `fromA`: how A sees B; `fromB`: how B sees A.
  NodeTest(const Sight& fromA, const Sight& fromB) : alongA_(fromA), alongB_(fromB) {}

  /// In the pair's unit of time; `from` may be before the start.
  Times<Real> operator()(const FourNodes& a, const FourNodes& b) const;

 private:
  /// A Sight, divided by the speed along each axis: a vertex q of the mesh that sees and p of the other are level at
  /// the time rate q - matrix p - offset, up to slack.
  struct Axes {
    LaneVec<Real> matrix[3], matrixSize[3];
    LaneVec<Real> speed, rate, rateSize, offset;
    LaneVec<Real> slack, normalSlack;
    bool complete = true;  ///< no axis had to be left out

    explicit Axes(const Sight& sight);
  };
  struct Nodes;

  static void cutByBox(Times<Real>& times, const Nodes& own, const Nodes& other, const Axes& axes);
  static void cutByNormal(Times<Real>& times, const Nodes& own, const Nodes& other, const Axes& axes);

  Axes alongA_, alongB_;
};

}  // namespace radar::cpu
