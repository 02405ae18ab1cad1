// Bounds the times at which triangles of two leaves can meet, for up to four pairs at a time, by the separating axes of
// each pair. docs/method.md derives the error bounds.
#pragma once

#include "cpu/node_test.h"

namespace radar::cpu {

/// A separating axis of triangles a and b: 0: the normal of a; 1: the normal of b; 2 + 3 i + k: across edge i of a and
/// edge k of b. Edge i goes from corner i to the next.
using Axis = int;

/// Times of the pairs of two leaves, of A and B: triangles i of A and k of B are in lane i + 2 k.
template <class Real>
struct LeafTimes {
  Times<Real> times;  ///< in the pair's unit of time, no earlier than `begin`
  Lanes<Real> axis;   ///< the Axis that gives `from`
  unsigned possible;  ///< one bit per lane whose pair may meet
};

/// Tests leaves of a mesh A, in motion, and of a mesh B. For one thread at a time: it caches the last leaf of each
/// mesh.
template <class Real>
class LeafTest {
 public:
  /// `relative`: how B sees A. The meshes outlive the test.
  LeafTest(const Mesh& meshA, const Mesh& meshB, const RelativePlacement& relative);

  /// Tests which pairs may meet from `begin` to `end`. The caller knows that none meets before `begin`.
  LeafTimes<Real> operator()(const gpu::MeshNode& a, const gpu::MeshNode& b, Real begin, Real end);

 private:
  /// Triangles of a leaf in B's frame; those of A without the translation between the frames.
  struct Side {
    const gpu::MeshNode* leaf = nullptr;
    LaneVec<double> corner;  ///< corner 0
    LaneVec<Real> edge[3], normal;
    Real size;  ///< bound on the sum of an edge's absolute components
  };
  void showA(const gpu::MeshNode& leaf);
  void showB(const gpu::MeshNode& leaf);

  const Mesh &meshA_, &meshB_;
  Side a_, b_;
  Matrix3 matrix_;
  Vector offset_, travel_;
  Real travelSize_ = 0;     // sum over the axes
  Real clearance_ = 0;      // along any axis
  Real positionError_ = 0;  // error of a corner of A relative to one of B, along any axis
  Real edgeError_ = 0;      // error of an edge, except its own rounding
  bool usable_ = true;
};

}  // namespace radar::cpu
