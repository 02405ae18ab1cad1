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

/// Of a way, the part after which all points of two meshes only get farther from each other.
Piece untilParting(Piece way, const MeshPlacement& a, const MeshPlacement& b) {
  double parting = 0;
  for (int k = 0; k < 3; ++k) {
    parting += std::abs(a.origin[k] - b.origin[k]) + a.extent[k] + b.extent[k] + a.error[k] + b.error[k];
  }
  if (way.rate > 0) way.end = std::min(way.end, way.from + 1.01 * parting / way.rate);
  return way;
}

}  // namespace

NearestSearch::Other::Other(ObjectId id, const Mesh& m, const Transform& p, const MeshPlacement& sensor,
                            const Translation& t, const Piece& w, const PairRule& r)
    : object(id),
      mesh(m),
      pose(p),
      placement(m, p),
      motion(t),
      way(untilParting(w, sensor, placement)),
      rule(r),
      pair(sensor, placement, way, std::numeric_limits<double>::infinity(), way.end),
      gap(sensor, placement, pair),
      lead(sensor, placement, pair),
      rounding(4 * std::sqrt(dot(pair.rounding, pair.rounding))) {}

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
  push(openOf(static_cast<uint32_t>(others_.size() - 1), 0, 0, {}));
}

NearestSearch::Open NearestSearch::openOf(uint32_t index, uint32_t a, uint32_t b, const Vector& across) const {
  const Other& other = others_[index];
  Open open{0, index, a, b, across};
  open.least = other.gap.least(sensor_->mesh.tree.nodes[a], other.mesh.tree.nodes[b], visitor_->reach(),
                               visitor_->across(), open.across);
  return open;
}

bool NearestSearch::matters(const Open& open) const {
  const double room = visitor_->leavesTies() ? others_[open.other].rounding : 0;
  if (open.least <= visitor_->reach() - room) return true;
  visitor_->skip(open.least);
  return false;
}

void NearestSearch::push(const Open& open) {
  if (!matters(open)) return;
  open_.push_back(open);
  std::ranges::push_heap(open_, std::ranges::greater(), &Open::least);
}

void NearestSearch::advance(double until, uint64_t& pairs) {
  while (!open_.empty() && open_[0].least <= until && matters(open_[0])) {
    std::ranges::pop_heap(open_, std::ranges::greater(), &Open::least);
    const Open open = open_.back();
    open_.pop_back();
    descend(open, pairs);
  }
}

// Down to two leaves: what is found there bounds the others.
void NearestSearch::descend(Open open, uint64_t& pairs) {
  const Other& other = others_[open.other];
  const MeshTree &treeA = sensor_->mesh.tree, &treeB = other.mesh.tree;
  for (;;) {
    if (++visits_ % kVisits == 0) throwIfStopped(*stop_);
    const gpu::MeshNode &a = treeA.nodes[open.a], &b = treeB.nodes[open.b];
    open.least = std::max(open.least, other.gap.leastAlong(visitor_->across(), a, b));
    if (!matters(open)) return;
    const MeshTree::Below &belowA = treeA.below[open.a], &belowB = treeB.below[open.b];
    if (visitor_->isBefore({other.object, belowB.least, belowA.least}) || other.lead.keepApart(a, b)) return;
    if (isLeaf(a) && isLeaf(b)) break;
    const bool opensA = isLeaf(b) || (!isLeaf(a) && sizeOf(sensor_->placement, a) > sizeOf(other.placement, b));
    const auto child = [&](uint32_t i) {
      return openOf(open.other, opensA ? a.link + i : open.a, opensA ? open.b : b.link + i, open.across);
    };
    Open nearer = child(0), farther = child(1);
    if (farther.least < nearer.least) std::swap(nearer, farther);
    push(farther);
    open = nearer;
  }
  const MeshTree::Below &belowA = treeA.below[open.a], &belowB = treeB.below[open.b];
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

}  // namespace radar::cpu
