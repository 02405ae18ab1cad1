#include "query/near_walk.h"

namespace radar {

std::vector<detail::OpenNode>& detail::openHeap() {
  thread_local std::vector<OpenNode> nodes;
  return nodes;
}

PassingBox::PassingBox(const Box& start, const Piece& piece, const ObjectTree& tree) {
  const Box& world = tree.worldBox();
  double parting = 0;
  for (int k = 0; k < 3; ++k) {
    const double anchor = tree.anchor()[k];
    middle_[k] = start.middle(k) - anchor;
    half_[k] = 0.5 * start.hi[k] - 0.5 * start.lo[k] + piece.deviation;
    const double far = std::max(std::abs(world.lo[k] - anchor), std::abs(world.hi[k] - anchor));
    rounding_[k] = std::abs(start.middle(k)) + half_[k] + std::abs(anchor) + 2 * far;
    parting += std::abs(middle_[k]) + half_[k] + far;
  }
  // After that, the box only gets farther from all objects.
  const double way = std::min(piece.wayUntil(piece.end), 1.01 * parting);
  for (int k = 0; k < 3; ++k) {
    travel_[k] = way * piece.unit[k];
    rounding_[k] = 32 * kUnit * (rounding_[k] + std::abs(travel_[k])) + 0x1p-1000;
  }
  perSquared_ = inverseSquare(travel_);
}

double PassingBox::least(const gpu::ObjectNode& node) const {
  Vector apart, half;
  for (int k = 0; k < 3; ++k) {
    apart[k] = middle_[k] - node.centre[k];
    half[k] = half_[k] + node.halfExtent[k];
  }
  const Vector n = acrossNearest(apart, half, travel_, perSquared_);
  const double height =
      dot(n, apart) - reachAlong(n, half) + std::min(dot(n, travel_), 0.0) - 2 * reachAlong(n, rounding_);
  return leastOf(height, n);
}

}  // namespace radar
