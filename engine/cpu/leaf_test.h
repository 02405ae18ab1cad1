// When triangles of two leaves can meet: up to four pairs at a time, by the axes that separate the triangles of a pair.
// The error bounds are derived in docs/method.md.
#pragma once

#include "cpu/node_test.h"

namespace radar::cpu {

/// What separates two triangles a and b: 0 is along the normal of a, 1 of b, 2 + 3 i + k across edge i of a and edge k
/// of b. Edge i goes from corner i to the next.
using Axis = int;

/// Of the pairs of triangle i of a leaf of A and triangle k of a leaf of B, in lane i + 2 k.
template <class Real>
struct LeafTimes {
  Times<Real> times;  ///< in the pair's unit of time, from the `begin` asked for
  Lanes<Real> axis;   ///< the Axis that gives `from`
  unsigned possible;  ///< a bit for each lane that holds a pair that may meet
};

/// Tests leaves of a mesh A, in motion, and of a mesh B. One thread at a time: what it has worked out of a leaf serves
/// the next test of that leaf.
template <class Real>
class LeafTest {
 public:
  /// `sight`: how B sees A. The meshes outlive the test.
  LeafTest(const Mesh& meshA, const Mesh& meshB, const Sight& sight);

  /// Asks what meets from `begin` to `end`, if anything does, and not before `begin`.
  LeafTimes<Real> operator()(const gpu::MeshNode& a, const gpu::MeshNode& b, Real begin, Real end);

 private:
  /// Triangles of a leaf in B's frame, those of A as if the way between the two frames were none.
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
  Matrix matrix_;
  Vector offset_, travel_;
  Real travelSize_ = 0;     // sum over the axes
  Real positionError_ = 0;  // of a corner of A from one of B, along any axis
  Real edgeError_ = 0;      // of an edge, beyond what it is rounded by
  bool usable_ = true;
};

}  // namespace radar::cpu
