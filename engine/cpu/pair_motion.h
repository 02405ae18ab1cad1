// Two placed meshes, one of them in motion, each as the other one sees it. The bounds are derived in docs/method.md.
#pragma once

#include "cpu/placement.h"

namespace radar::cpu {

/// What matters of the motion of A past B. Time counts from 0 to 1, which is after `span`.
struct PairMotion {
  Vector gap;       ///< from B's origin to A's
  Vector travel;    ///< of A in a unit of time
  Vector rounding;  ///< per world axis: bound on what a position or a displacement is off by
  double span;      ///< world units; no contact that matters comes later

  /// Contacts later than `latest` do not matter.
  PairMotion(const Placement& a, const Placement& b, const Motion& motion, double latest);

  /// `distance` in units of time, or a little later; 1 at most.
  double timeOf(double distance) const { return span > 0 ? std::min((1 + 8 * kUnit) * (distance / span), 1.0) : 1.0; }
};

/// How one mesh sees the other in its normalised frame: a vertex p of the other is at matrix p + offset + t travel, off
/// by at most `slack` along each axis.
struct Sight {
  Matrix matrix;
  Vector offset, travel, slack;
  Vector magnitude;  ///< per axis: bound on a vertex of either mesh, and on all that is added up to place it

  /// `side`: 1 where the other mesh is the one in motion, else -1.
  Sight(const MeshAxes& own, const Placement& other, const PairMotion& motion, int side);
};

/// Bounds on the times of something.
struct TimeSpan {
  double from = 0, to = 1;
  bool empty() const { return from > to; }
};

/// Cuts `times` down to those at which the box of a node of the mesh that sees can meet that of a node of the other.
void narrow(TimeSpan& times, const Sight& sight, const gpu::MeshNode& own, const gpu::MeshNode& other);

}  // namespace radar::cpu
