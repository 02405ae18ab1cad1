// A mesh that turns on its way past another one, for a part of the way: where both ends of the part put it, and how far
// from the straight ways between them its points get. docs/method.md derives the bounds.
#pragma once

#include <algorithm>
#include <cmath>

#include "cpu/pair_motion.h"

namespace radar::cpu {

inline double norm(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

/// World units: how far points of a mesh may bend off their straight ways in a part. `radius`: of the placed mesh.
double bendAllowed(const Mesh& mesh, const Transform& pose, double radius);
/// In how many equal parts a way of that `angle`, radians, is searched. `bend`: double(double share): how far points
/// bend off in such a share of the way.
template <class Bend>
double partsOf(double angle, double allowed, const Bend& bend) {
  // A part's box is at most an eighth larger than the mesh's, and takes some 700 bytes.
  constexpr double kMostAngle = 0.25, kMostParts = 1 << 14;
  double count = std::max(std::ceil(angle / kMostAngle), 1.0);
  while (count < kMostParts && bend(1 / count) > allowed) count *= 1.5;
  return std::min(std::ceil(count), kMostParts);
}

/// A part of a way, past objects that stand. Its straight way, for the walk of the tree over objects, is that of a box.
struct PathPart {
  /// Where the mesh is at an end, and its middle with it.
  struct End {
    double s;
    Transform pose;
    Vector middle;
  };
  PathPart(const Mesh& mesh, const End& first, const End& last, double bend, double error);

  double from, end;     ///< s
  MeshPlacement at[2];  ///< of the sensor, at both
  MeshAxes axes[2];
  double bend;   ///< world units: no point gets farther from its straight way, but for rounding
  double error;  ///< world units: of a place, by rounding, beside MeshPlacement::error
  Box start;     ///< around the sensor, while its middle is where it is at `from`
  Piece piece;   ///< of that middle; its deviation includes `bend` and `error`
};

/// One mesh in the other's normalised frame, at both ends of a part: a vertex p of the former is at matrix p + offset.
struct PathPlacement {
  Matrix3 matrix[2];
  Vector offset[2], slack;  ///< slack: how far off that is between the ends, with the clearance and all rounding

  struct Frame {
    const MeshAxes* axes[2];
    const MeshPlacement* own[2];
    const MeshPlacement* other[2];
    Vector gap[2];  ///< from the own origin to the other's
    double apart;   ///< world units: clearance and rounding
    double bend;    ///< world units, across the axis
    Vector axis;    ///< of length 1; 0: in any direction
  };
  explicit PathPlacement(const Frame& frame);
};

}  // namespace radar::cpu
