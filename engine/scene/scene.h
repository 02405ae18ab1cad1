// The contents of radar::Scene.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <queue>
#include <span>
#include <string>
#include <vector>

#include "math/box.h"
#include "radar/answers.h"
#include "radar/query.h"
#include "scene/changed_pages.h"
#include "scene/large_vector.h"
#include "scene/mesh.h"
#include "scene/object_tree.h"

namespace radar {

using FreeIds = std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>>;

struct Scene::Impl {
  Impl();
  struct ObjectSlot {
    Object object;
    bool used = false;
  };
  /// Unique. A Scene may be moved into another's place, and versions of different scenes are not comparable.
  uint64_t identity;
  std::vector<Mesh> meshes;
  LargeVector<ObjectSlot> objects;
  FreeIds freeMeshes, freeObjects;  ///< the least is used next
  /// Increase with every change of their kind; a reader that has seen the current value is up to date.
  uint64_t meshVersion = 0;
  uint64_t structureVersion = 0;  ///< objects added or removed
  uint64_t poseVersion = 0;       ///< any object changed
  uint64_t boundsVersion = 0;     ///< any object's bounds changed, but not by its removal
  /// For each object, the poseVersion at which it last changed; and by pages of objects.
  std::vector<uint64_t> changedAt;
  ChangedPages changedObjects;
  /// Records that objects were added, moved or removed.
  void change(std::span<const ObjectId> changed);
  void change(ObjectId object) { change({&object, 1}); }
  MeshId add(Mesh mesh);
  /// Makes an id free if none is. If it throws, nothing has changed.
  void makeRoom();
  size_t moving = 0;               ///< number of objects that move during a step
  std::map<ObjectId, Box> bounds;  ///< where a host may move objects, with a margin, world coordinates

  /// The up-to-date tree over the objects' world boxes, built or refitted at the first call after a change. Any thread
  /// may call this while the scene does not change.
  const ObjectTree& objectTree() const;

  /// Null if a host does not move the object.
  const Box* boundsOf(ObjectId object) const {
    const auto found = bounds.find(object);
    return found == bounds.end() ? nullptr : &found->second;
  }

 private:
  mutable std::mutex treeMutex_;
  mutable ObjectTree tree_;
  mutable ObjectChanges treeChanges_;  // since the tree's last update
};

/// The corners of a triangle of the placed mesh.
std::array<Vector, 3> placedTriangle(const Mesh& mesh, const Transform& worldFromMesh, uint32_t triangle);

/// The sum of absolute values from which a coordinate is summed, at most, where `row` (n t) takes vectors with
/// components of at most `sizes`.
inline double magnitudeAlong(const double* row, const Vector& sizes) {
  double sum = std::abs(row[3]);
  for (int k = 0; k < 3; ++k) sum += std::abs(row[k]) * sizes[k];
  return sum;
}

/// The greatest of these for a placed mesh, over its axes. No placed coordinate is larger. `farthest`: of the mesh.
double placedMagnitude(const Vector& farthest, const Transform& worldFromMesh);

/// A box around the transformed mesh. It contains every vertex that `transformPoint` computes, and every one that a
/// shader computes from the local floats.
Box boxOf(const Mesh& mesh, const std::array<double, 12>& parentFromMesh);

/// Whether a query takes a step.
inline bool isStep(const Query& query, const Scene::Impl& scene) {
  return query.motion || query.turn || scene.moving > 0;
}

/// Components of displacements up to this are valid: their sums and lengths do not overflow.
inline constexpr double kMostMotion = 0x1p1000;
/// Whether a pose certainly passes the test of validate(), as most do.
bool isSurelyValid(const Transform& pose);
/// Empty, or what is wrong with a pose that is to be rigid to 1e-6: the products of its columns.
std::string validateRigid(const Transform& pose);
/// Empty, or what is wrong with a displacement during a step.
std::string validateMotion(const std::array<double, 3>& motion);

/// The determinant of the 3x3 part.
double determinant(const Transform& pose);

}  // namespace radar
