// Searches for the pairs of triangles of a sensor and one object that matter to a visitor: traverses both meshes'
// trees, nearest first.
#pragma once

#include <string>
#include <vector>

#include "cpu/first_contact.h"
#include "cpu/path_contact.h"
#include "cpu/path_part.h"
#include "query/cancelled.h"

namespace radar::cpu {

/// What one thread writes has cache lines of its own, in pairs, as processors fetch them.
inline constexpr size_t kThreadLines = 128;

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

/// Two meshes during a part of their ways.
struct PathPair {
  PlacedMesh sensor, other;  ///< as the contact takes their triangles
  ObjectId object;
  double from = 0, end = 1;  ///< s
  struct End {
    const MeshPlacement* placement = nullptr;
    const MeshAxes* axes = nullptr;  ///< null: of the placement, computed if needed; the same at both ends
  };
  End a[2], b[2];       ///< the sensor and the other
  Vector gap[2];        ///< from the sensor's origin to the other's, at both ends
  double apart = 0;     ///< world units: clearance, and rounding of places beside MeshPlacement::error
  double bend = 0;      ///< of PathPlacement::Frame: of the sensor, as the other sees it
  double bendSeen = 0;  ///< of the other, where it may touch the sensor, as that sees it
  Vector axis{};        ///< of PathPlacement::Frame
  double steps = 0;     ///< if above 0, pairs are considered from an end of so many equal steps on, since their places
                        ///< are dear to compute
};

/// What a body in a part of its way and an object, which moves by `drift` in all of s, have in common with any others;
/// the bends are to be set.
PathPair pairOf(const PlacedMesh& body, const PathPart& part, const PlacedMesh& object, ObjectId name,
                const Vector& drift, double clearance);

/// Two nodes that cannot meet before `near`.
struct OpenPair {
  float near;
  uint32_t a, b;
};

/// Reuses its memory between searches. For one thread at a time.
class MeshSearch {
 public:
  /// Passes all pairs of triangles that may matter to `visitor`. There is no contact before `near`, in the
  /// pair's unit of time. Adds the pairs of triangles that are tested to `pairs`. Throws Cancelled soon after `stop` is
  /// requested.
  void run(const MeshPair& pair, double near, PairVisitor& visitor, uint64_t& pairs, const std::stop_token& stop);
  void run(const PathPair& pair, PathContact& contact, uint64_t& pairs, const std::stop_token& stop);

 private:
  OpenPair* openFor(const PlacedMesh& a, const PlacedMesh& b);

  std::vector<OpenPair> open_;
};

/// The sets of instructions for which searches are compiled and that this processor has: searches use the last. No
/// answer depends on it.
std::vector<std::string> searchInstructions();
/// For tests: of all searches from now on. `name` is one of searchInstructions().
void setSearchInstructions(const std::string& name);

}  // namespace radar::cpu
