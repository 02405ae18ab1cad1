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

bool mayMeet(const PlacedTriangle& a, const PlacedTriangle& b, double latest) {
  const Lanes below = b.lo - a.hi, above = b.hi - a.lo;  // differences b - a lie between
  if (below[0] > 0 || below[1] > 0 || below[2] > 0 || above[0] < 0 || above[1] < 0 || above[2] < 0) return false;
  if (below[3] > latest || above[3] < 0) return false;

  const double width = std::max(std::max(above[0], -below[0]), std::max(above[1], -below[1]));
  const double error = a.error + b.error + kUnit * width;
  // Bound on the error of each cross product of two differences.
  const double bound = 4 * width * error + 4 * error * error + 4 * kUnit * width * width;

  double x[3][3], y[3][3];
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      x[i][k] = b.corners[k][0] - a.corners[i][0];
      y[i][k] = b.corners[k][1] - a.corners[i][1];
    }
  }
  constexpr int kNext[3] = {1, 2, 0};
  double overA[3][3], overB[3][3];  // [edge of a][vertex of b], [edge of b][vertex of a]: orientation seen along the motion
  for (int i = 0; i < 3; ++i) {
    const int j = kNext[i];
    for (int k = 0; k < 3; ++k) overA[i][k] = x[i][k] * y[j][k] - y[i][k] * x[j][k];
    const double most = std::max(std::max(overA[i][0], overA[i][1]), overA[i][2]);
    const double least = std::min(std::min(overA[i][0], overA[i][1]), overA[i][2]);
    if ((a.area > a.areaError && most < -bound) || (a.area < -a.areaError && least > bound)) return false;
  }
  for (int k = 0; k < 3; ++k) {
    const int l = kNext[k];
    for (int i = 0; i < 3; ++i) overB[k][i] = x[i][k] * y[i][l] - y[i][k] * x[i][l];
    const double most = std::max(std::max(overB[k][0], overB[k][1]), overB[k][2]);
    const double least = std::min(std::min(overB[k][0], overB[k][1]), overB[k][2]);
    if ((b.area > b.areaError && most < -bound) || (b.area < -b.areaError && least > bound)) return false;
  }

  // What is left is incident somewhere, or nearly so. Its interval [t0, t1] is spanned by the possible events.
  double first = kNever, last = -kNever;
  const double zError = 2 * (a.error + b.error);
  const double rangeA = a.hi[3] - a.lo[3], rangeB = b.hi[3] - b.lo[3];
  const auto event = [&](double t, double wide) {
    first = std::min(first, t - wide);
    last = std::max(last, t + wide);
  };
  const auto corner = [&](double p, double q, double r, double zp, double zq, double zr, double z0, double range,
                          double turn) {
    // Weights p, q, r of the face's vertices, opposite to edges; all of one sign if the vertex is over the face.
    if (!((p >= -bound && q >= -bound && r >= -bound) || (p <= bound && q <= bound && r <= bound))) return;
    const double sum = p + q + r;
    const double z = (p * zp + q * zq + r * zr) / sum;
    const double wide = 8 * bound * range / std::abs(sum) + zError;
    if (wide < kNever) {
      event(turn * (z - z0), wide);
    } else {
      event(0, kNever);
    }
  };
  for (int i = 0; i < 3; ++i) {
    corner(overB[1][i], overB[2][i], overB[0][i], b.corners[0][3], b.corners[1][3], b.corners[2][3], a.corners[i][3],
           rangeB, 1);
    corner(overA[1][i], overA[2][i], overA[0][i], a.corners[0][3], a.corners[1][3], a.corners[2][3], b.corners[i][3],
           rangeA, -1);
    const int j = kNext[i];
    for (int k = 0; k < 3; ++k) {
      const int l = kNext[k];
      const double p = overA[i][k], q = overA[i][l], r = overB[k][i], s = overB[k][j];
      if ((p > bound && q > bound) || (p < -bound && q < -bound) || (r > bound && s > bound) ||
          (r < -bound && s < -bound)) {
        continue;
      }
      const double zb = (q * b.corners[k][3] - p * b.corners[l][3]) / (q - p);
      const double za = (s * a.corners[i][3] - r * a.corners[j][3]) / (s - r);
      const double wide = 6 * bound * (rangeA / std::abs(s - r) + rangeB / std::abs(q - p)) + zError;
      if (wide < kNever) {
        event(zb - za, wide);
      } else {
        event(0, kNever);
      }
    }
  }
  return first <= latest && last >= 0;
}

}  // namespace radar::reference
