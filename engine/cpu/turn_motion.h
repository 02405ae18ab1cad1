// A mesh that turns past another one, for a part of the turn: where both ends of the part put it, and how far from the
// straight ways between them its points get. docs/method.md derives the bounds.
#pragma once

#include <vector>

#include "cpu/node_test.h"
#include "query/turning.h"

namespace radar::cpu {

/// A part of a turn, past objects that stand. Its straight way, for the walk of the tree over objects, is that of a
/// box.
struct TurnPart {
  double from, end;     ///< s
  MeshPlacement at[2];  ///< of the sensor, at both
  MeshAxes axes[2];
  double bend;   ///< world units: no point gets farther from its straight way, but for rounding
  double error;  ///< world units: of a place, by rounding, beside MeshPlacement::error
  Box start;     ///< around the sensor, while its middle is where it is at `from`
  Piece piece;   ///< of that middle; its deviation includes `bend` and `error`
};

/// A turn in parts so short that no point of a mesh bends away from its way by more than a share of its triangles.
class TurnMotion {
 public:
  TurnMotion(const Query& query, const Mesh& sensor);

  const Turning& turning() const { return turning_; }
  std::span<const TurnPart> parts() const { return parts_; }
  /// Bound on the speed of the sensor's points relative to an object that moves by `objectWay`, world units per s.
  double speedPast(const Vector& objectWay) const;
  /// World units: how far a point of an object that may touch the sensor gets from its straight way in the part, as
  /// seen from the sensor.
  double bendSeen(const TurnPart& part, const Vector& objectWay) const;

 private:
  Turning turning_;
  double radius_;  // of the sensor about the axis, and what is within its clearance, at most
  std::vector<TurnPart> parts_;
};

/// One mesh in the other's normalised frame, at both ends of a part: a vertex p of the former is at matrix p + offset.
struct TurnPlacement {
  Matrix3 matrix[2];
  Vector offset[2], slack;  ///< slack: how far off that is between the ends, with the clearance and all rounding

  struct Frame {
    const MeshAxes* axes[2];
    const MeshPlacement* own[2];
    const MeshPlacement* other[2];
    Vector gap[2];  ///< from the own origin to the other's
    double apart;   ///< world units: clearance and rounding
    double bend;    ///< world units, across the axis
    Vector axis;
  };
  explicit TurnPlacement(const Frame& frame);
};

/// As NodeTest, by the slabs along both meshes' axes.
class TurnTest {
 public:
  TurnTest(const TurnPlacement& fromA, const TurnPlacement& fromB) : alongA_(fromA), alongB_(fromB) {}
  /// Time runs from 0 to 1 in the part.
  Times<double> operator()(const FourNodes& a, const FourNodes& b) const;
  /// Whether the first of each stay apart along the first one's axes.
  static bool areApart(const TurnPlacement& fromOwn, const FourNodes& own, const FourNodes& other);

 private:
  struct Axes {
    LaneVec<double> matrix[2][3], size[2][3], offset[2], slack;
    explicit Axes(const TurnPlacement& placement);
  };
  struct Boxes;
  static void cut(Times<double>& times, const Boxes& own, const Boxes& other, const Axes& axes);

  Axes alongA_, alongB_;
};

}  // namespace radar::cpu
