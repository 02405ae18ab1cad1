// Searches for the pairs of triangles of a sensor and one object that matter to a visitor: traverses both meshes'
// trees, nearest first.
#pragma once

#include <vector>

#include "cpu/node_test.h"
#include "cpu/pair_visitor.h"

namespace radar::cpu {

/// Work of the searches since construction.
struct SearchStats {
  uint64_t nodes = 0;       ///< node pairs tested
  uint64_t pairs = 0;       ///< triangle pairs tested
  uint64_t exactPairs = 0;  ///< triangle pairs that needed exact integers
};

/// A mesh and its pose.
struct PlacedMesh {
  const Mesh& mesh;
  const Transform& pose;
};

/// A sensor in motion, an object, and each mesh in the other's frame.
struct MeshPair {
  PlacedMesh sensor, other;
  ObjectId object;
  const PairMotion& motion;
  const RelativePlacement &fromSensor, &fromOther;
};

/// Reuses its memory between searches. For one thread at a time.
class MeshSearch {
 public:
  /// Passes all pairs of triangles that may matter to `visitor`. There is no contact before `near`, in the
  /// pair's unit of time.
  void run(const MeshPair& pair, double near, PairVisitor& visitor, SearchStats& stats);

 private:
  /// Two nodes that cannot meet before `near`.
  struct Open {
    float near;
    uint32_t a, b;
  };

  template <class Real>
  void descend(const MeshPair& pair, double near, PairVisitor& visitor, SearchStats& stats);

  std::vector<Open> open_;
};

}  // namespace radar::cpu
