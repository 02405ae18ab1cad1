// Searches for the pairs of triangles of a sensor and one object that matter to a visitor: traverses both meshes'
// trees, nearest first.
#pragma once

#include <vector>

#include "cpu/first_contact.h"
#include "cpu/node_test.h"
#include "cpu/turn_contact.h"
#include "query/cancelled.h"

namespace radar::cpu {

/// A mesh and its pose.
struct PlacedMesh {
  const Mesh& mesh;
  const Transform& pose;
  const MeshPlacement& placement;  ///< of the same pose
};

/// A sensor in motion, an object, and each mesh in the other's frame.
struct MeshPair {
  PlacedMesh sensor, other;
  ObjectId object;
  const PairMotion& motion;
  const RelativePlacement &fromSensor, &fromOther;
};

/// The same in a part of a turn.
struct TurningPair {
  PlacedMesh sensor, other;  ///< at the start of the step
  ObjectId object;
  const TurnPart& part;
  const TurnPlacement &fromSensor, &fromOther;
};

/// Reuses its memory between searches. For one thread at a time.
class MeshSearch {
 public:
  /// Passes all pairs of triangles that may matter to `visitor`. There is no contact before `near`, in the
  /// pair's unit of time. Adds the pairs of triangles that are tested to `pairs`. Throws Cancelled soon after `stop` is
  /// requested.
  void run(const MeshPair& pair, double near, PairVisitor& visitor, uint64_t& pairs, const std::stop_token& stop);
  /// The same in a part of a turn; `near`: of 1, the whole part.
  void run(const TurningPair& pair, double near, TurnContact& contact, uint64_t& pairs, const std::stop_token& stop);

 private:
  /// Two nodes that cannot meet before `near`.
  struct Open {
    float near;
    uint32_t a, b;
  };

  template <class Opener, class Test>
  void descend(const MeshTree& treeA, const MeshTree& treeB, const Opener& opener, ObjectId object, double near,
               Test& test, PairVisitor& visitor, const std::stop_token& stop);

  std::vector<Open> open_;
};

}  // namespace radar::cpu
