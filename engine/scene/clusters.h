// Triangles in spatial order, in clusters of 64, with a tree over them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace radar {

struct Mesh;

inline constexpr uint32_t kClusterTriangles = 64;

/// A node of the tree: a cluster (count > 0: triangles [first, first + count) of the order) or a parent (count 0) of
/// the nodes `first` and `first` + 1. The box is of recentred vertices, centre and half extents, mesh units.
struct ClusterNode {
  std::array<float, 3> centre{}, half{};
  std::array<float, 3> edge{};  ///< the longest of its triangles'; only of a cluster
  uint32_t first = 0, count = 0;
};

struct Clusters {
  std::vector<uint32_t> order;     ///< triangle ids; neighbours in space are near each other
  std::vector<ClusterNode> nodes;  ///< the root first, parents before children
  uint32_t leaves = 0;             ///< how many nodes are clusters
};

/// Cuts at the median along the axis in which the triangles' middles spread most, at multiples of 64, so that all
/// clusters but a few are full. `mesh` has its recentred vertices.
Clusters clustersOf(const Mesh& mesh);

}  // namespace radar
