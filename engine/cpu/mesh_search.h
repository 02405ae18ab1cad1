// The search for first contact between a sensor and one object: down both meshes' trees, nearest first.
#pragma once

#include <vector>

#include "cpu/first_contact.h"
#include "cpu/node_test.h"

namespace radar::cpu {

/// What searches have done since they were made.
struct SearchStats {
  uint64_t nodes = 0;       ///< pairs of nodes tested
  uint64_t pairs = 0;       ///< pairs of triangles tested
  uint64_t exactPairs = 0;  ///< those of them that needed exact integers
};

/// A mesh and its pose.
struct PlacedMesh {
  const Mesh& mesh;
  const Pose& pose;
};

/// A sensor in motion, an object, and how they see each other.
struct MeshPair {
  PlacedMesh sensor, other;
  ObjectId object;
  const PairMotion& motion;
  const Sight &fromSensor, &fromOther;
};

/// Keeps its memory from one search to the next. One thread at a time.
class MeshSearch {
 public:
  /// Shows `first` all pairs of triangles that may be the first contact. Nothing meets before `near`, in the pair's
  /// unit of time.
  void run(const MeshPair& pair, double near, FirstContact& first, SearchStats& stats);

 private:
  /// Two nodes that cannot meet before `near`.
  struct Open {
    float near;
    uint32_t a, b;
  };

  template <class Real>
  void descend(const MeshPair& pair, double near, FirstContact& first, SearchStats& stats);

  std::vector<Open> open_;
};

}  // namespace radar::cpu
