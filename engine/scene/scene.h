// The contents of radar::Scene, and the data derived from each mesh when it is added.
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
#include "scene/mesh_tree.h"
#include "scene/object_tree.h"

namespace radar {

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  bool used = false;
  bool hasBounds = false;        ///< declared, within which a host may move its vertices
  uint32_t objects = 0;          ///< number of objects that use it
  uint32_t firstHostVertex = 0;  ///< the number of vertex 0 in a host's buffer
  /// The numbers of all vertices there, less that one; empty if they are consecutive.
  std::vector<uint32_t> hostVertices;
  uint64_t version = 0;  ///< unique over all meshes of all scenes; compared with a device copy's

  /// Derived. A local vertex is position - origin, so that a part modelled far from its origin keeps its float
  /// precision. The origin's components are floats that make this difference exact: 0 on axes where the mesh spans or
  /// is near 0, its middle on the others. One array per axis, so that loops over vertices vectorise.
  Vector origin{};
  std::array<std::vector<float>, 3> local;
  Vector farthest{};             ///< greatest |coordinate|, declared bounds included
  Box box;                       ///< of local vertices, declared bounds included
  std::array<float, 3> reach{};  ///< greatest |coordinate| in the box
  double meanEdge = 0;           ///< mean length of the triangles' edges

  /// A power of two such that normalised vertices, local / unit, are below 2 on all axes. The division is exact.
  double unit = 1;
  MeshTree tree;

  /// gpu::Vertex::number.
  uint32_t hostVertex(uint32_t vertex) const { return hostVertices.empty() ? vertex : hostVertices[vertex]; }
  /// |origin| + reach: what positions are summed from on their way to a place, at most.
  Vector span() const {
    return {std::abs(origin[0]) + reach[0], std::abs(origin[1]) + reach[1], std::abs(origin[2]) + reach[2]};
  }
  uint32_t vertexCount() const { return static_cast<uint32_t>(positions.size() / 3); }
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
  float normalised(uint32_t vertex, int axis) const {
    return static_cast<float>(local[axis][vertex] * (1 / unit));  // in doubles: 1 / 2^-149 is no float
  }
};

/// Sets what a mesh derives from a box around the vertices that its triangles use: `origin`, `farthest`, `box`, `reach`
/// and `unit`.
void setBox(Mesh& mesh, const Box& box);

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
  std::vector<ObjectSlot> objects;
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
  return query.motion.has_value() || scene.moving > 0;
}

/// Components of displacements up to this are valid: their sums and lengths do not overflow.
inline constexpr double kMostMotion = 0x1p1000;
/// Empty, or what is wrong with a displacement during a step.
std::string validateMotion(const std::array<double, 3>& motion);

/// The determinant of the 3x3 part.
double determinant(const Transform& pose);

}  // namespace radar
