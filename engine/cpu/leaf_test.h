// Bounds the times at which triangles of leaves can meet, for up to four pairs of triangles of each pair of leaves, by
// the separating axes of each pair. docs/method.md derives the error bounds.
#pragma once

#include "cpu/certificate.h"
#include "cpu/node_test.h"

namespace radar::cpu {

inline namespace RADAR_WIDTH {

/// Pairs of leaves, of A and B, that are tested together, four lanes each: triangles i of A and k of B are in lane
/// i + 2 k of the four.
struct LeafPairs {
  static constexpr int kMost = kLanes / 4;
  const gpu::MeshNode *a[kMost] = {}, *b[kMost] = {};
  float near[kMost] = {};  ///< the pair does not meet before, in the pair of meshes' unit of time
  int count = 0;

  void add(const gpu::MeshNode& leafA, const gpu::MeshNode& leafB, float earliest) {
    // What is not filled repeats the last.
    for (int i = count; i < kMost; ++i) {
      a[i] = &leafA;
      b[i] = &leafB;
      near[i] = earliest;
    }
    ++count;
  }
};

/// Times of the pairs of triangles, by the lanes of LeafPairs.
template <class Real>
struct LeafTimes {
  Lanes<Real> from;   ///< bounds when they meet, in the pair's unit of time; off by a rounding
  Lanes<Real> axis;   ///< the Axis that gives `from`
  unsigned possible;  ///< one bit per lane whose pair may meet
};

/// Tests leaves of a mesh A, in motion, and of a mesh B. For one thread at a time: it caches the last leaves of each
/// mesh.
template <class Real>
class LeafTest {
 public:
  /// `relative`: how B sees A. The meshes outlive the test.
  LeafTest(const Mesh& meshA, const Mesh& meshB, const RelativePlacement& relative);

  /// Tests which pairs may meet by `end`.
  LeafTimes<Real> timesOf(const LeafPairs& pairs, Real end);

 private:
  /// Triangles of leaves in B's frame; those of A without the translation between the frames.
  struct Side {
    const gpu::MeshNode* leaves[LeafPairs::kMost] = {};
    LaneVec<double> corner;  ///< corner 0
    LaneVec<Real> edge[3], normal;
    Lanes<Real> size;  ///< bound on the sum of an edge's absolute components
  };
  void showA(const LeafPairs& pairs);
  void showB(const LeafPairs& pairs);

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

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
