#include "cpu/nearest_search.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar::cpu {

namespace {

// Between two looks at whether the search is still wanted.
constexpr uint32_t kVisits = 256;

/// A bound on the sides of a node's box, world units.
double sizeOf(const MeshPlacement& placement, const gpu::MeshNode& node) {
  const Vector half{node.halfExtent[0], node.halfExtent[1], node.halfExtent[2]};
  double size = 0;
  for (const Vector& row : placement.linear) size += reachAlong(row, half);
  return size;
}

}  // namespace

NearestSearch::Other::Other(ObjectId id, const Mesh& m, const Transform& p, const MeshPlacement& sensor,
                            const Translation& t, const Piece& w, const PairRule& r)
    : object(id),
      mesh(m),
      pose(p),
      placement(m, p),
      motion(t),
      way(w),
      rule(r),
      pair(sensor, placement, way, std::numeric_limits<double>::infinity(), way.end),
      gap(sensor, placement, pair),
      lead(sensor, placement, pair) {}

void NearestSearch::begin(const PlacedMesh& sensor, NearVisitor& visitor, const std::stop_token& stop) {
  sensor_ = &sensor;
  visitor_ = &visitor;
  stop_ = &stop;
  others_.clear();
  open_.clear();
}

void NearestSearch::add(ObjectId object, const Mesh& mesh, const Transform& pose, const Translation& motion,
                        const Piece& way, const PairRule& rule, const Lead& lead) {
  throwIfStopped(*stop_);
  Other& other = others_.emplace_back(object, mesh, pose, sensor_->placement, motion, way, rule);
  other.lead.set(lead.way, lead.by, way.end);
  push(static_cast<uint32_t>(others_.size() - 1), 0, 0, {});
}

void NearestSearch::push(uint32_t index, uint32_t a, uint32_t b, const Vector& across) {
  const Other& other = others_[index];
  const gpu::MeshNode &nodeA = sensor_->mesh.tree.nodes[a], &nodeB = other.mesh.tree.nodes[b];
  Open open{0, index, a, b, across};
  open.least = other.gap.least(nodeA, nodeB, visitor_->reach(), visitor_->across(), open.across);
  if (open.least > visitor_->reach()) return visitor_->skip(open.least);
  open_.push_back(open);
  std::ranges::push_heap(open_, std::ranges::greater(), &Open::least);
}

void NearestSearch::advance(double until, uint64_t& pairs) {
  const MeshTree& treeA = sensor_->mesh.tree;
  while (!open_.empty() && open_[0].least <= until) {
    if (open_[0].least > visitor_->reach()) return visitor_->skip(open_[0].least);
    if (++visits_ % kVisits == 0) throwIfStopped(*stop_);
    std::ranges::pop_heap(open_, std::ranges::greater(), &Open::least);
    const Open open = open_.back();
    open_.pop_back();
    const Other& other = others_[open.other];
    const MeshTree& treeB = other.mesh.tree;
    const MeshTree::Below &belowA = treeA.below[open.a], &belowB = treeB.below[open.b];
    if (visitor_->isBefore({other.object, belowB.least, belowA.least})) continue;
    const gpu::MeshNode &a = treeA.nodes[open.a], &b = treeB.nodes[open.b];
    if (other.lead.keepApart(a, b)) continue;
    if (!isLeaf(a) || !isLeaf(b)) {
      const bool opensA = isLeaf(b) || (!isLeaf(a) && sizeOf(sensor_->placement, a) > sizeOf(other.placement, b));
      for (uint32_t child = 0; child < 2; ++child) {
        if (opensA) push(open.other, a.link + child, open.b, open.across);
        if (!opensA) push(open.other, open.a, b.link + child, open.across);
      }
      continue;
    }
    pairs += size_t{belowA.count} * belowB.count;
    for (uint32_t i = 0; i < belowA.count * belowB.count; ++i) {
      const uint32_t triA = treeA.order[belowA.first + i % belowA.count];
      const uint32_t triB = treeB.order[belowB.first + i / belowA.count];
      visitor_->consider(
          {other.object, triB, triA},
          {placedTriangle(sensor_->mesh, sensor_->pose, triA), placedTriangle(other.mesh, other.pose, triB)},
          other.motion, other.rule);
    }
  }
}

}  // namespace radar::cpu
