#include "cpu/nearest_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar::cpu {

namespace {

// Between two looks at whether the search is still wanted.
constexpr uint32_t kVisits = 256;

/// A node's box: where it is, relative to an origin of both meshes, and half its extent along the world's axes.
struct PlacedNode {
  const Matrix3& linear;
  const gpu::MeshNode& node;
  Vector middle, half;

  PlacedNode(const MeshPlacement& placement, const Vector& origin, const gpu::MeshNode& box)
      : linear(placement.linear), node(box), middle(origin) {
    for (int i = 0; i < 3; ++i) {
      half[i] = 0;
      for (int k = 0; k < 3; ++k) {
        middle[i] += linear[i][k] * node.centre[k];
        half[i] += std::abs(linear[i][k]) * node.halfExtent[k];
      }
    }
  }
  /// How far the box reaches along n, times the length of n.
  double reachAlong(const Vector& n) const {
    double reach = 0;
    for (int k = 0; k < 3; ++k) {
      reach += std::abs(n[0] * linear[0][k] + n[1] * linear[1][k] + n[2] * linear[2][k]) * node.halfExtent[k];
    }
    return reach;
  }
};

/// Bound on the distance of what two nodes hold: of their boxes along the world's axes, or along the line of their
/// middles; infinite if all pairs have the lead.
double leastBetween(const PlacedNode& a, const PlacedNode& b, const Vector& rounding, const Lead& lead) {
  Vector apart, gap;
  for (int i = 0; i < 3; ++i) {
    apart[i] = a.middle[i] - b.middle[i];
    gap[i] = std::max(std::abs(apart[i]) - a.half[i] - b.half[i] - rounding[i], 0.0);
  }
  const double ahead = dot(lead.way, apart) - a.reachAlong(lead.way) - b.reachAlong(lead.way);
  if (ahead - radar::reachAlong(lead.way, rounding) > (1 + 8 * kUnit) * lead.by) {
    return std::numeric_limits<double>::infinity();
  }
  const double length = std::sqrt(dot(apart, apart)), boxes = std::sqrt(dot(gap, gap));
  if (!(length > 0)) return boxes;
  const double along = length * length - a.reachAlong(apart) - b.reachAlong(apart) - radar::reachAlong(apart, rounding);
  return (1 - 8 * kUnit) * std::max(boxes, along / length);
}

}  // namespace

void NearestSearch::run(const PlacedMesh& sensor, const PlacedMesh& other, ObjectId object, NearestAtStart& nearest,
                        uint64_t& pairs, const std::stop_token& stop) {
  const MeshTree &treeA = sensor.mesh.tree, &treeB = other.mesh.tree;
  const MeshPlacement &ofA = sensor.placement, &ofB = other.placement;
  Vector gap, rounding;
  for (int i = 0; i < 3; ++i) {
    gap[i] = ofA.origin[i] - ofB.origin[i];
    rounding[i] = ofA.error[i] + ofB.error[i] + 32 * kUnit * (ofA.extent[i] + ofB.extent[i] + std::abs(gap[i]));
  }
  const auto placedA = [&](uint32_t a) { return PlacedNode(ofA, gap, treeA.nodes[a]); };
  const auto placedB = [&](uint32_t b) { return PlacedNode(ofB, {}, treeB.nodes[b]); };
  const auto openOf = [&](uint32_t a, uint32_t b) {
    return Open{leastBetween(placedA(a), placedB(b), rounding, nearest.lead()), a, b};
  };
  open_ = {openOf(0, 0)};
  for (uint32_t visits = 1; !open_.empty(); ++visits) {
    if (visits % kVisits == 0) throwIfStopped(stop);
    const Open open = open_.back();
    open_.pop_back();
    const MeshTree::Below &belowB = treeB.below[open.b], &belowA = treeA.below[open.a];
    if (open.least > nearest.reach() || nearest.isBefore({object, belowB.least, belowA.least})) continue;
    const gpu::MeshNode &a = treeA.nodes[open.a], &b = treeB.nodes[open.b];
    if (!isLeaf(a) || !isLeaf(b)) {
      const bool opensA = isLeaf(b) || (!isLeaf(a) && norm1(placedA(open.a).half) > norm1(placedB(open.b).half));
      Open nearer = opensA ? openOf(a.link, open.b) : openOf(open.a, b.link);
      Open farther = opensA ? openOf(a.link + 1, open.b) : openOf(open.a, b.link + 1);
      if (farther.least < nearer.least) std::swap(nearer, farther);
      open_.push_back(farther);
      open_.push_back(nearer);
      continue;
    }
    pairs += size_t{belowA.count} * belowB.count;
    for (uint32_t i = 0; i < belowA.count * belowB.count; ++i) {
      const uint32_t triA = treeA.order[belowA.first + i % belowA.count];
      const uint32_t triB = treeB.order[belowB.first + i / belowA.count];
      nearest.consider({object, triB, triA},
                       {placedTriangle(sensor.mesh, sensor.pose, triA), placedTriangle(other.mesh, other.pose, triB)});
    }
  }
}

}  // namespace radar::cpu
