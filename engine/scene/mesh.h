// A scene's mesh, and the data derived from it when it is added or deformed.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "math/box.h"
#include "math/ring_hull.h"
#include "radar/scene.h"
#include "scene/mesh_tree.h"

namespace radar {

/// Triangles or objects of a tree, which has at most twice as many nodes, half as many again after edits; a link has 30
/// bits for an item and 31 for a node (gpu::kLinkItem).
inline constexpr size_t kMostItems = size_t{1} << 29;

struct Mesh {
  UnwrittenVector<float> positions;
  UnwrittenVector<uint32_t> indices;
  bool used = false;
  std::vector<RingHull> parts;   ///< of a cutter, which its triangles only show; else empty
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
  std::array<UnwrittenVector<float>, 3> local;
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

/// As of Scene::addMesh, but for its version.
Mesh makeMesh(std::span<const float> positions, std::span<const uint32_t> indices, const std::optional<Bounds>& bounds);

/// Of a cutter. Throws as Scene::addCutter.
std::vector<RingHull> hullsOf(const Cutter& cutter);
/// Triangles that show a cutter.
struct DrawnCutter {
  std::vector<float> positions;
  std::vector<uint32_t> indices;
};
DrawnCutter drawn(std::span<const RingHull> hulls);

/// As of Scene::setPositions. If it throws, nothing has changed.
void movePositions(Mesh& mesh, std::span<const float> positions);

/// Throws an Error that names the call if the bounds are invalid.
Box boxOf(const char* call, const Bounds& bounds);

void requireAtMost(const char* where, const char* what, size_t count, size_t most);

}  // namespace radar
