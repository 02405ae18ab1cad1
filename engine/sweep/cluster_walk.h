// The clusters of a placed mesh, through its tree.
#pragma once

#include <cmath>
#include <vector>

#include "scene/scene.h"
#include "sweep/frame.h"

namespace radar {

/// Around what a node holds, placed, each vertex up to `error` off.
inline Box turned(const ClusterNode& node, const Affine& frameFromMesh, double error) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromMesh[4 * row];
    double middle = r[3], half = error;
    for (int k = 0; k < 3; ++k) {
      middle += r[k] * node.centre[k];
      half += std::abs(r[k]) * node.half[k];
    }
    box.lo[row] = middle - half;
    box.hi[row] = middle + half;
  }
  return box;
}

/// Calls found(node number, box) for each cluster, in the order of their triangles, that `wanted`(box) holds for, as it
/// must for every box around a wanted one.
template <class Wanted, class Found>
void walkClusters(const Clusters& clusters, const Affine& frameFromMesh, double error, const Wanted& wanted,
                  const Found& found) {
  thread_local std::vector<uint32_t> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const uint32_t at = open.back();
    open.pop_back();
    const ClusterNode& node = clusters.nodes[at];
    const Box box = turned(node, frameFromMesh, error);
    if (!wanted(box)) continue;
    if (node.count == 0) {
      open.push_back(node.first + 1);
      open.push_back(node.first);
    } else {
      found(at, box);
    }
  }
}

}  // namespace radar
