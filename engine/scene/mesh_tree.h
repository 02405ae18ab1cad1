// The bounding-volume tree over a mesh's triangles, as both searches walk it: on the device and on the CPU.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "shaders/interop.h"

namespace radar {

struct Mesh;

/// Coordinates are of local vertices, normalised (Mesh::local, Mesh::unit).
struct MeshTree {
  std::vector<gpu::MeshNode> nodes;  ///< links count from the mesh's first node and its first place in `order`
  std::vector<uint32_t> order;       ///< triangle ids, leaf by leaf: neighbours in space are near each other
  /// The places in `order` of what is below a node, and the least triangle id there.
  struct Below {
    uint32_t first, count, least;
  };
  std::vector<Below> below;  ///< of each node
  uint32_t depth = 0;        ///< nodes on the longest way from the root to a leaf
};

/// `mesh` has its local vertices.
MeshTree buildMeshTree(const Mesh& mesh);

/// Half extents and centre that hold [lo, hi], whatever the rounding.
void fitBox(const std::array<float, 3>& lo, const std::array<float, 3>& hi, float (&centre)[3], float (&half)[3]);

}  // namespace radar
