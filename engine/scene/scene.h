// The scene as the engine sees it: what radar::Scene holds, and what is derived from a mesh once, when it is added.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <queue>
#include <vector>

#include "radar/radar.h"
#include "scene/clusters.h"

namespace radar {

/// An axis-aligned box; empty while lo > hi.
struct Box {
  std::array<double, 3> lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
  void add(const std::array<double, 3>& p);
  void merge(const Box& b);
};

struct Mesh {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
  bool used = false;
  bool deforms = false;  ///< a host may move its vertices, within halfExtent of the centre
  uint32_t objects = 0;  ///< how many place it
  uint64_t version = 0;  ///< unique over all meshes of all scenes: what a device copy is compared with

  /// Derived. Vertices are recentred for pictures and boxes, so that a part modelled far from its origin keeps its
  /// float precision: recentred[i] = float(positions[i] - centre). The centre is of floats, for shaders that do the
  /// same. One array per axis, so that loops over vertices vectorise.
  std::array<double, 3> centre{};
  std::array<std::vector<float>, 3> recentred;
  std::array<float, 3> halfExtent{};  ///< of the recentred vertices' box, or of what a host may make of it
  double meanEdge = 0;                ///< mean length of the triangles' edges

  Clusters clusters;

  uint32_t vertexCount() const { return static_cast<uint32_t>(positions.size() / 3); }
  uint32_t triangleCount() const { return static_cast<uint32_t>(indices.size() / 3); }
};

using FreeIds = std::priority_queue<uint32_t, std::vector<uint32_t>, std::greater<>>;

struct Scene::Impl {
  Impl();
  struct ObjectSlot {
    Object object;
    bool used = false;
  };
  /// Unlike that of any other scene: a Scene may be moved into another's place, where versions mean nothing.
  uint64_t identity;
  std::vector<Mesh> meshes;
  std::vector<ObjectSlot> objects;
  FreeIds freeMeshes, freeObjects;  ///< the least is given next
  /// Rise with every change of their kind; a reader that has seen the current value has nothing to do.
  uint64_t meshVersion = 0;
  uint64_t structureVersion = 0;  ///< objects added or removed
  uint64_t poseVersion = 0;       ///< any object changed
  /// For each object, the poseVersion at which it last changed.
  std::vector<uint64_t> changedAt;
  std::map<ObjectId, Box> bounds;  ///< where a host may move them, with some room; world

  /// Null: nowhere.
  const Box* boundsOf(ObjectId object) const {
    const auto found = bounds.find(object);
    return found == bounds.end() ? nullptr : &found->second;
  }
};

/// Whether two boxes, one of them widened by `slack`, have a point in common.
bool overlap(const Box& a, const Box& b, double slack);

/// A box around the placed mesh, in a frame: parentFromMesh is row-major 3x4 in double precision. Holds every vertex
/// that `place` computes and every one a shader computes from the recentred floats.
Box boxOf(const Mesh& mesh, const std::array<double, 12>& parentFromMesh);

/// The same for a matrix that takes recentred vertices. What double precision loses on the way to that matrix is the
/// caller's to add.
Box boxOfRecentred(const Mesh& mesh, const std::array<double, 12>& parentFromRecentred);

/// Of the 3x3 part.
double determinant(const Pose& pose);

}  // namespace radar
