// The clusters of a placed mesh: small groups of neighbouring triangles, drawn or skipped together.
#pragma once

#include <cmath>
#include <vector>

#include "math/frame.h"
#include "scene/scene.h"

namespace radar {

/// Largest number of triangles in a cluster.
inline constexpr uint32_t kClusterTriangles = 64;

/// A box, in the frame, around the contents of a mesh tree's node, whose placed vertices are off by up to `error`.
/// `frameFromNormalised` takes normalised vertices.
inline Box turned(const gpu::MeshNode& node, const Affine& frameFromNormalised, double error) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromNormalised[4 * row];
    double middle = r[3], half = error;
    for (int k = 0; k < 3; ++k) {
      middle += r[k] * node.centre[k];
      half += std::abs(r[k]) * node.halfExtent[k];
    }
    box.lo[row] = middle - half;
    box.hi[row] = middle + half;
  }
  return box;
}

/// Calls found(MeshTree::Below, box) for each cluster with wanted(box), in the order of their triangles. `wanted` must
/// hold for every box around a wanted one.
template <class Wanted, class Found>
void walkClusters(const Mesh& mesh, const Affine& frameFromLocal, double error, const Wanted& wanted,
                  const Found& found) {
  Affine frameFromNormalised = frameFromLocal;
  for (int i = 0; i < 12; ++i) frameFromNormalised[i] *= i % 4 == 3 ? 1 : mesh.unit;
  thread_local std::vector<uint32_t> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const uint32_t at = open.back();
    open.pop_back();
    const gpu::MeshNode& node = mesh.tree.nodes[at];
    const Box box = turned(node, frameFromNormalised, error);
    if (!wanted(box)) continue;
    if (mesh.tree.below[at].count > kClusterTriangles) {
      open.push_back(node.link + 1);
      open.push_back(node.link);
    } else {
      found(mesh.tree.below[at], box);
    }
  }
}

}  // namespace radar
