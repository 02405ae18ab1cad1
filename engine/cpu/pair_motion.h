// Two placed meshes, one of them in motion, each in the other's frame. docs/method.md derives the bounds.
#pragma once

#include "exact/translation.h"
#include "scene/scene.h"

namespace radar::cpu {

using Matrix3 = std::array<Vector, 3>;  ///< rows

/// Places normalised vertices: world = origin + linear * q.
struct MeshPlacement {
  Vector origin;
  Matrix3 linear;
  Vector extent;  ///< per world axis: bound on |linear * q|
  Vector error;   ///< per world axis: bound on the difference between `transformPoint` and the formula above

  MeshPlacement(const Mesh& mesh, const Transform& worldFromMesh);
};

/// Covectors along a mesh's normalised axes: the rows of the inverse, except for rounding, which `residual` bounds. Any
/// covectors would be valid.
struct MeshAxes {
  Matrix3 rows;
  Vector residual;  ///< per row k: the sum over columns j of |rows[k] . linear[.][j] - (j == k)|, as computed

  explicit MeshAxes(const Matrix3& linear);
};

/// A piece of the motion of A past B. Time runs from 0 to 1; time 1 is distance `span`.
struct PairMotion {
  const Piece& piece;
  Vector gap;        ///< from B's origin to A's, at the piece's start
  Vector travel;     ///< of A per unit of time
  Vector rounding;   ///< per world axis: bound on the error of a position or a displacement
  double clearance;  ///< world units: pairs matter that come this near on the straight way
  double span;       ///< world units; no contact that matters comes later

  /// `piece` outlives this. Meshes meet when they come as near as `clearance`. Contacts later than t = `latest`, which
  /// is not before the piece, do not matter.
  PairMotion(const MeshPlacement& a, const MeshPlacement& b, const Piece& piece, double clearance, double latest);

  /// `t` in units of time, rounded up; 1 at most.
  double timeOf(double t) const { return span > 0 ? std::min((1 + 8 * kUnit) * (piece.wayUntil(t) / span), 1.0) : 1.0; }
};

/// One mesh in the other's normalised frame: a vertex p of the former is at matrix p + offset + t travel, with an error
/// of at most `rounding` along each axis. With the motion's clearance, along each axis, that is `slack`.
struct RelativePlacement {
  Matrix3 matrix;
  Vector offset, travel, rounding, slack;
  Vector magnitude;  ///< per axis: bound on a vertex of either mesh, and on the terms summed to place it

  /// `side`: 1 if the other mesh is the one in motion, else -1.
  RelativePlacement(const MeshAxes& own, const MeshPlacement& other, const PairMotion& motion, int side);
};

/// A time interval.
struct TimeSpan {
  double from = 0, to = 1;
  bool empty() const { return from > to; }
};

/// Narrows `times` to those at which the boxes of `own` and `other` can meet.
void narrow(TimeSpan& times, const RelativePlacement& relative, const gpu::MeshNode& own, const gpu::MeshNode& other);

}  // namespace radar::cpu
