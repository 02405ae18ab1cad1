// The clusters of a placed mesh that can be in reach.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "sweep/frame.h"

namespace radar {

/// A cluster, and a box in the frame that holds every vertex a shader places.
struct ReachedCluster {
  uint32_t node;  ///< of the mesh
  Box box;
};

/// Appends the clusters of a placed mesh whose boxes meet `within`, in the tree's order. `error`: how far a vertex that
/// a shader places may be off.
void collectClusters(const Clusters& clusters, const Affine& frameFromMesh, double error, const Box& within,
                     std::vector<ReachedCluster>& out);

}  // namespace radar
