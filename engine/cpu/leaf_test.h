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
  Times<Real> times;  ///< in the pair's unit of time, from the `begin` that was asked for
  Lanes<Real> axis;   ///< the Axis that gives `from`
  unsigned possible;  ///< a bit for each lane that holds a pair that may meet
};

/// Tests leaves of a mesh A, in motion, and of a mesh B.
template <class Real>
class LeafTest {
 public:
  /// `sight`: how B sees A.
  explicit LeafTest(const Sight& sight);

  /// Asks what meets from `begin` to `end`, if anything does, and not before `begin`.
  LeafTimes<Real> operator()(const Mesh& meshA, const gpu::MeshNode& a, const Mesh& meshB, const gpu::MeshNode& b,
                             Real begin, Real end) const;

 private:
  struct Triangles;

  Matrix matrix_;
  Vec offset_, travel_;
  Real travelSize_ = 0;     // sum over the axes
  Real positionError_ = 0;  // of a corner of A from one of B, along any axis
  Real edgeError_ = 0;      // of an edge, beyond what it is rounded by
  bool usable_ = true;
};

}  // namespace radar::cpu
