// Bounds the times at which nodes of two meshes can meet in a part of a way that turns.
#pragma once

#include "cpu/node_test.h"
#include "cpu/path_part.h"

namespace radar::cpu {

inline namespace RADAR_WIDTH {

/// As NodeTest, by the slabs along both meshes' axes.
class PathTest {
 public:
  PathTest(const PathPlacement& fromA, const PathPlacement& fromB) : alongA_(fromA), alongB_(fromB) {}
  /// Time runs from 0 to 1 in the part.
  Times<double> operator()(const NodeLanes& a, const NodeLanes& b) const;
  /// Whether the first of each stay apart along the first one's axes.
  static bool areApart(const PathPlacement& fromOwn, const NodeLanes& own, const NodeLanes& other);

 private:
  struct Axes {
    LaneVec<double> matrix[2][3], size[2][3], offset[2], slack;
    explicit Axes(const PathPlacement& placement);
  };
  struct Boxes;
  static void cut(Times<double>& times, const Boxes& own, const Boxes& other, const Axes& axes);

  Axes alongA_, alongB_;
};

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
