#include "cpu/path_test.h"

#include <cmath>

namespace radar::cpu {

inline namespace RADAR_WIDTH {

PathTest::Axes::Axes(const PathPlacement& placement) {
  for (int k = 0; k < 3; ++k) {
    const bool usable = placement.slack[k] < INFINITY;
    slack[k] = placement.slack[k];
    for (int e = 0; e < 2; ++e) {
      offset[e][k] = usable ? placement.offset[e][k] : 0;
      for (int j = 0; j < 3; ++j) {
        const double entry = usable ? placement.matrix[e][k][j] : 0;
        matrix[e][k][j] = entry;
        size[e][k][j] = std::abs(entry);
      }
    }
  }
}

struct PathTest::Boxes {
  LaneVec<double> centre, half;

  explicit Boxes(const NodeLanes& nodes) {
    Floats lanes[4];
    load(nodes, 0, lanes);
    for (int k = 0; k < 3; ++k) centre[k] = lanes[k];
    load(nodes, 1, lanes);
    for (int k = 0; k < 3; ++k) half[k] = lanes[k];
  }
};

namespace {

/// Cuts off the times t at which a number is below 0 that changes evenly, from g0 at 0 to g1 at 1.
void cutBelow(Times<double>& times, const Lanes<double>& g0, const Lanes<double>& g1) {
  using L = Lanes<double>;
  const L zero = 0.0, never = double{INFINITY}, at = g0 / (g0 - g1);
  const L from = select(zero, g0, select(zero, g1, never, at * L(1 - 4 * kUnit)), -never);
  const L to = select(zero, g1, select(zero, g0, -never, at * L(1 + 4 * kUnit)), never);
  times.from = max(from, times.from);
  times.to = min(to, times.to);
}

}  // namespace

// The middle of the other box, less that of the own, stays within half the sum of their extents, where they meet.
void PathTest::cut(Times<double>& times, const Boxes& own, const Boxes& other, const Axes& axes) {
  for (int k = 0; k < 3; ++k) {
    Lanes<double> middle[2], half[2];
    for (int e = 0; e < 2; ++e) {
      middle[e] = axes.offset[e][k] + dot(axes.matrix[e][k], other.centre) - own.centre[k];
      half[e] = dot(axes.size[e][k], other.half) + own.half[k] + axes.slack[k];
    }
    cutBelow(times, half[0] - middle[0], half[1] - middle[1]);
    cutBelow(times, half[0] + middle[0], half[1] + middle[1]);
  }
}

bool PathTest::areApart(const PathPlacement& fromOwn, const NodeLanes& own, const NodeLanes& other) {
  Times<double> times{0.0, 1.0};
  cut(times, Boxes(own), Boxes(other), Axes(fromOwn));
  return times.from[0] > times.to[0];
}

Times<double> PathTest::operator()(const NodeLanes& nodesA, const NodeLanes& nodesB) const {
  const Boxes a(nodesA), b(nodesB);
  Times<double> times{0.0, 1.0};
  cut(times, a, b, alongA_);
  cut(times, b, a, alongB_);
  return times;
}

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
