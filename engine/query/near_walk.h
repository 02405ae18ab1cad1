// The objects to which a query's sensor may come nearest on its way.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "query/swept.h"

namespace radar {

/// Of a motion by `travel`: 1 / |travel|^2, or 0 if it stands.
inline double inverseSquare(const Vector& travel) {
  const double squared = dot(travel, travel);
  return squared > 0 ? 1 / squared : 0;
}

/// A normal across the gap between two boxes with half extents that sum up to `half`, and whose middles are `apart` at
/// time 0; at time `at` of the first one's motion by `travel`. 0 if they meet then. `perSquared`: inverseSquare() if
/// they pass each other at that time, so that the normal is to lie across the motion; else 0.
inline Vector acrossGap(const Vector& apart, const Vector& half, const Vector& travel, double at, double perSquared) {
  const Vector then = along(apart, at, travel);
  Vector n;
  for (size_t i = 0; i < 3; ++i) n[i] = std::copysign(std::max(std::abs(then[i]) - half[i], 0.0), then[i]);
  return perSquared > 0 ? along(n, -perSquared * dot(n, travel), travel) : n;
}

/// The same at about the time, from 0 to 1, at which they are nearest.
inline Vector acrossNearest(const Vector& apart, const Vector& half, const Vector& travel, double perSquared) {
  const double nearest = -perSquared * dot(apart, travel), at = std::clamp(nearest, 0.0, 1.0);
  return acrossGap(apart, half, travel, at, at == nearest ? perSquared : 0);
}

/// The distance of planes across n between which there is nothing: `height` over the length of n, rounded down; 0 where
/// products under- or overflow.
inline double leastOf(double height, const Vector& n) {
  const double squared = dot(n, n);
  const bool isInRange = squared > 0x1p-900 && squared < 0x1p900 && height < 0x1p900;
  return isInRange && height > 0 ? (1 - 8 * kUnit) * (height / std::sqrt(squared)) : 0;
}

/// Bounds the distances between a moving world box and boxes of the tree over objects.
class PassingBox {
 public:
  /// `tree` must be in range.
  PassingBox(const Box& start, const Piece& piece, const ObjectTree& tree);
  /// Nothing of the node comes nearer on the whole way, world units.
  double least(const gpu::ObjectNode& node) const;

 private:
  Vector middle_, half_, travel_, rounding_;
  double perSquared_;
};

namespace detail {

/// Memory of this thread for the nodes that a walk has yet to visit, nearest first.
std::vector<OpenNode>& openHeap();

}  // namespace detail

/// Calls `visit` with each participant that may come nearer to `start`, in motion, than a reach, world units; nearest
/// boxes first. `reach`: double(double near): asked before objects that come no nearer than `near`. `visit` must not
/// walk itself.
template <class Reach, class Visit>
void walkNear(const Participants& participants, const ObjectTree& tree, const Piece& piece, const Box& start,
              const Reach& reach, const Visit& visit) {
  const Scene::Impl& scene = participants.scene();
  if (!tree.inRange()) {
    for (ObjectId id = 0; id < scene.objects.size(); ++id) {
      if (scene.objects[id].used && participants.contain(id)) visit(id);
    }
    return;
  }
  if (tree.nodes().empty()) return;
  const gpu::ObjectNode* const nodes = tree.nodes().data();
  const PassingBox passes(start, piece, tree);
  std::vector<detail::OpenNode>& open = detail::openHeap();
  const auto isFarther = [](const detail::OpenNode& p, const detail::OpenNode& q) { return p.near > q.near; };
  const auto push = [&](const gpu::ObjectNode& node) {
    const double near = passes.least(node);
    open.push_back({near, node.link});
    std::push_heap(open.begin(), open.end(), isFarther);
  };
  open.clear();
  push(nodes[0]);
  while (!open.empty()) {
    std::pop_heap(open.begin(), open.end(), isFarther);
    const detail::OpenNode next = open.back();
    open.pop_back();
    if (next.near > reach(next.near)) return;
    if ((next.link & gpu::kLinkLeaf) != 0) {
      const ObjectId id = next.link & gpu::kLinkItem;
      if (participants.contain(id)) visit(id);
      continue;
    }
    push(nodes[next.link]);
    push(nodes[next.link + 1]);
  }
}

}  // namespace radar
