#include "reference/placed.h"

#include <algorithm>
#include <cmath>

namespace radar::reference {

namespace {

double cross(const Lanes& p, const Lanes& q) {
  return p[0] * q[1] - p[1] * q[0];
}

}  // namespace

TreeMesh::TreeMesh(const MeshView& view) : mesh(view) {
  std::vector<Bounds<float>> boxes(mesh.triangleCount());
  for (uint32_t t = 0; t < boxes.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      float c[3];
      for (int i = 0; i < 3; ++i) c[i] = mesh.positions[3 * size_t{mesh.indices[3 * size_t{t} + i]} + k];
      boxes[t].lo[k] = std::min({c[0], c[1], c[2]});
      boxes[t].hi[k] = std::max({c[0], c[1], c[2]});
    }
  }
  tree.build(boxes, kLeafSize);
  const auto& nodes = tree.nodes();
  for (int k = 0; k < 3; ++k) extent[k] = std::max(std::abs(double(nodes[0].lo[k])), std::abs(double(nodes[0].hi[k])));
  least.resize(nodes.size());
  for (size_t i = nodes.size(); i-- > 0;) {
    const auto& node = nodes[i];
    const auto first = tree.order().begin() + node.first;
    least[i] = node.count != 0 ? *std::min_element(first, first + node.count)
                               : std::min(least[node.first], least[node.first + 1]);
  }
}

void LeafCache::bind(const TreeMesh& mesh, const Pose& pose, const View& view) {
  ++generation_;
  mesh_ = &mesh;
  pose_ = &pose;
  view_ = &view;
}

const PlacedLeaf& LeafCache::leaf(uint32_t node) {
  PlacedLeaf& leaf = leaves_[node % kLeaves];
  const uint64_t key = generation_ << 32 | node;
  if (leaf.key != key) {
    place(leaf, mesh_->tree.nodes()[node]);
    leaf.key = key;
  }
  return leaf;
}

void LeafCache::place(PlacedLeaf& leaf, const Tree<float>::Node& node) const {
  leaf.count = node.count;
  for (uint32_t i = 0; i < node.count; ++i) {
    PlacedTriangle& out = leaf.triangles[i];
    out.id = mesh_->tree.order()[node.first + i];
    double farthest = 0;
    for (int corner = 0; corner < 3; ++corner) {
      const uint32_t vertex = mesh_->mesh.indices[3 * size_t{out.id} + corner];
      const Vec p = radar::place(*pose_, &mesh_->mesh.positions[3 * size_t{vertex}]);
      const Vec local{p[0] - view_->origin[0], p[1] - view_->origin[1], p[2] - view_->origin[2]};
      out.world[corner] = p;
      out.corners[corner] = view_->turn(local);
      farthest = std::max(farthest, std::abs(local[0]) + std::abs(local[1]) + std::abs(local[2]));
    }
    out.error = 24 * kUnit * farthest;
    out.lo = out.corners[0].min(out.corners[1]).min(out.corners[2]) - out.error;
    out.hi = out.corners[0].max(out.corners[1]).max(out.corners[2]) + out.error;
    out.area = cross(out.corners[1] - out.corners[0], out.corners[2] - out.corners[0]);
    const double width = std::max(out.hi[0] - out.lo[0], out.hi[1] - out.lo[1]);
    const double error = 2 * out.error + kUnit * width;
    out.areaError = 4 * width * error + 4 * error * error + 4 * kUnit * width * width;
  }
}

}  // namespace radar::reference
