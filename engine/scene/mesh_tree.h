// The bounding-volume tree over a mesh's triangles, for the searches on the device and on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "scene/large_vector.h"
#include "shaders/shared/interop.h"

namespace radar {

struct Mesh;

inline bool isLeaf(const gpu::MeshNode& node) {
  return (node.link & gpu::kLinkLeaf) != 0;
}

/// In normalised local coordinates (Mesh::local, Mesh::unit).
struct MeshTree {
  NodeVector<gpu::MeshNode> nodes;       ///< links are relative to the mesh's first node, or to its start in `order`
  UnwrittenVector<uint32_t> order;       ///< triangle ids, leaf by leaf, so neighbours in space are close
  UnwrittenVector<float> corners;        ///< of the triangles in this order: x, y, z of each corner; then kPadding more
  static constexpr size_t kPadding = 3;  ///< so that vectors of four may be loaded
  /// The range of `order` below a node, and its least triangle id.
  struct Below {
    uint32_t first, count, least;
  };
  UnwrittenVector<Below> below;  ///< per node
  uint32_t depth = 0;            ///< nodes on the longest path from the root to a leaf
  double builtCost = 0;          ///< of the tree when it was built: see Fitter::fit in mesh_tree.cpp
};

/// `mesh` must have its local vertices.
MeshTree buildMeshTree(const Mesh& mesh);

/// Calls `move`, which moves the vertices of the mesh and does not throw, and fits its tree; builds that anew if it has
/// become much worse, and memory allows. If it throws, nothing has changed.
void refitMeshTree(const Mesh& mesh, MeshTree& tree, const std::function<void()>& move);

}  // namespace radar
