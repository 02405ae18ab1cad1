// Bounds on how near nodes of two meshes' trees come, by a plane across their gap, where the slabs of node_test.h would
// let pass what is up to 1.7 clearances away along a diagonal.
#pragma once

#include <algorithm>
#include <cmath>

#include "cpu/pair_motion.h"
#include "query/near_walk.h"

namespace radar::cpu {

/// Bound on n . x for all points x of a node, relative to the origin of the mesh: as of its box, or of its slab and
/// of the rest of its box.
inline double topAlong(const gpu::MeshNode& node, const Matrix3& linear, const Vector& n) {
  double box = 0, slab = 0, along = 0;
  Vector m;
  for (int k = 0; k < 3; ++k) {
    m[k] = n[0] * linear[0][k] + n[1] * linear[1][k] + n[2] * linear[2][k];
    along += m[k] * node.normal[k];
  }
  for (int k = 0; k < 3; ++k) {
    const double rest = m[k] - along * node.normal[k];
    box += m[k] * node.centre[k] + std::abs(m[k]) * node.halfExtent[k];
    slab += rest * node.centre[k] + std::abs(rest) * node.halfExtent[k];
  }
  return std::min(box, slab + along * node.slabMiddle + std::abs(along) * node.slabHalf);
}

/// Tells nodes that stay farther apart than a distance, by their extents along a normal.
class GapTest {
 public:
  /// All outlive this.
  GapTest(const MeshPlacement& a, const MeshPlacement& b, const PairMotion& motion) : a_(a), b_(b), motion_(motion) {}

  /// `n`: from B to A, or 0: nothing is known. `distance`: world units. `latest`: as of a PairVisitor.
  void set(const Vector& n, double distance, double latest);
  bool keepApart(const gpu::MeshNode& a, const gpu::MeshNode& b) const {
    if (!isKnown_) return false;
    double height = height_;
    for (int k = 0; k < 3; ++k) {
      height += alongA_[k] * a.centre[k] - std::abs(alongA_[k]) * a.halfExtent[k];
      height -= alongB_[k] * b.centre[k] + std::abs(alongB_[k]) * b.halfExtent[k];
    }
    return height > 0;
  }

 private:
  const MeshPlacement &a_, &b_;
  const PairMotion& motion_;
  bool isKnown_ = false;
  Vector alongA_{}, alongB_{};
  double height_ = 0;
};

/// Finds a plane across the gap between the boxes of two nodes, at a time of its choice.
class NodeGap {
 public:
  /// All outlive this.
  NodeGap(const MeshPlacement& a, const MeshPlacement& b, const PairMotion& motion)
      : a_(a), b_(b), motion_(motion), perSquared_(inverseSquare(motion.travel)) {}

  /// When they come within the motion's clearance: not before this, in the pair's unit of time; after `latest` if not
  /// until then.
  double reached(const gpu::MeshNode& a, const gpu::MeshNode& b, double latest) const;
  /// How near they come on the whole way: no nearer than this, world units. Tight only up to `enough`.
  /// `likely`, `across`: normals that may give it, or 0; `across` is set to one that does.
  double least(const gpu::MeshNode& a, const gpu::MeshNode& b, double enough, const Vector& likely,
               Vector& across) const;

  /// The same by a plane across n; 0 if n is.
  double leastAlong(const Vector& n, const gpu::MeshNode& a, const gpu::MeshNode& b) const {
    return leastOf(heightAlong(n, a, b) + std::min(dot(n, motion_.travel), 0.0), n);
  }

 private:
  struct Boxes {
    Vector apart;  ///< of their middles, at the start
    Vector half;   ///< of both, along the world's axes
  };
  Boxes boxesOf(const gpu::MeshNode& a, const gpu::MeshNode& b) const;
  /// Of all differences of a point of A's box, on its way, and one of B's box, the one that reaches least along n.
  Vector farthestBack(const Vector& n, const Vector& apart, const gpu::MeshNode& a, const gpu::MeshNode& b) const;
  /// How far they are apart along n at the start, at least.
  double heightAlong(const Vector& n, const gpu::MeshNode& a, const gpu::MeshNode& b) const;

  const MeshPlacement &a_, &b_;
  const PairMotion& motion_;
  double perSquared_;
};

}  // namespace radar::cpu
