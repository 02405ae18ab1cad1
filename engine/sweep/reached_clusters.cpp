#include "sweep/reached_clusters.h"

#include <cmath>

namespace radar {

namespace {

Box turned(const ClusterNode& node, const Affine& m, double error) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
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

}  // namespace

void collectClusters(const Clusters& clusters, const Affine& frameFromMesh, double error, const Box& within,
                     std::vector<ReachedCluster>& out) {
  thread_local std::vector<uint32_t> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const uint32_t at = open.back();
    open.pop_back();
    const ClusterNode& node = clusters.nodes[at];
    const Box box = turned(node, frameFromMesh, error);
    if (!overlap(box, within, 0)) continue;
    if (node.count == 0) {
      open.push_back(node.first + 1);
      open.push_back(node.first);
    } else {
      out.push_back({at, box});
    }
  }
}

}  // namespace radar
