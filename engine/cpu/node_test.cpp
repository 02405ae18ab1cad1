#include "cpu/node_test.h"

#include <cmath>
#include <cstring>

namespace radar::cpu {

inline namespace RADAR_WIDTH {

namespace {

// Slabs along normals are tested if one of the two is thinner than this fraction of its box.
constexpr float kThin = 0.5f;

/// Rounds `x` up; `x` is not negative and not subnormal.
template <class Real>
Real roundedUp(double x) {
  return static_cast<Real>(x * (1 + 4 * kRounding<Real>));
}

template <class Real>
void cut(Times<Real>& times, const Lanes<Real>& middle, const Lanes<Real>& half) {
  times.from = max(times.from, middle - half);
  times.to = min(times.to, middle + half);
}

}  // namespace

template <class Real>
NodeTest<Real>::Axes::Axes(const RelativePlacement& relative) {
  for (int k = 0; k < 3; ++k) {
    // A speed near 0 is raised; the slack covers the difference.
    const double used =
        std::copysign(std::max(std::abs(relative.travel[k]), double{kLeastSpeed<Real>}), relative.travel[k]);
    const double wide = relative.slack[k] + std::abs(used - relative.travel[k]);
    const double magnitude = relative.magnitude[k] + kLeastSpeed<Real>, inverse = 1 / used;
    const bool usable = magnitude + wide < kMostMagnitude<Real>;
    for (int j = 0; j < 3; ++j) {
      const auto entry = usable ? static_cast<Real>(inverse * relative.matrix[k][j]) : Real(0);
      matrix[k][j] = entry;
      matrixSize[k][j] = std::abs(entry);
    }
    speed[k] = usable ? static_cast<Real>(used) : Real(0);
    rate[k] = usable ? static_cast<Real>(inverse) : Real(0);
    rateSize[k] = usable ? static_cast<Real>(std::abs(inverse)) : Real(0);
    offset[k] = usable ? static_cast<Real>(inverse * relative.offset[k]) : Real(0);
    const auto inTime = [&](double width) {
      return usable ? roundedUp<Real>(std::abs(inverse) * width) : Real(INFINITY);
    };
    slack[k] = inTime(wide + 16 * kRounding<Real> * magnitude);
    normalSlack[k] = inTime(wide + 128 * kRounding<Real> * magnitude);
    complete = complete && usable;
  }
}

/// Boxes and slabs of nodes, one in each lane.
template <class Real>
struct NodeTest<Real>::Nodes {
  LaneVec<Real> centre, half, normal;
  Lanes<Real> slabMiddle, slabHalf;

  void loadBoxes(const NodeLanes& nodes) {
    Floats lanes[4];
    load(nodes, 0, lanes);
    for (int k = 0; k < 3; ++k) centre[k] = lanes[k];
    load(nodes, 1, lanes);
    for (int k = 0; k < 3; ++k) half[k] = lanes[k];
    slabMiddle = lanes[3];
  }
  void loadNormals(const NodeLanes& nodes) {
    Floats lanes[4];
    load(nodes, 2, lanes);
    for (int k = 0; k < 3; ++k) normal[k] = lanes[k];
    slabHalf = lanes[3];
  }
  /// Positive if the slab is thin.
  Lanes<Real> thinness() const {
    return Lanes<Real>(Real(kThin)) * (abs(normal[0]) * half[0] + abs(normal[1]) * half[1] + abs(normal[2]) * half[2]) -
           slabHalf;
  }
};

template <class Real>
[[gnu::always_inline]] inline void NodeTest<Real>::cutByBox(Times<Real>& times, const Nodes& own, const Nodes& other,
                                                            const Axes& axes) {
  for (int k = 0; k < 3; ++k) {
    cut(times, axes.rate[k] * own.centre[k] - axes.offset[k] - dot(axes.matrix[k], other.centre),
        axes.rateSize[k] * own.half[k] + axes.slack[k] + dot(axes.matrixSize[k], other.half));
  }
}

template <class Real>
[[gnu::always_inline]] inline void NodeTest<Real>::cutByNormal(Times<Real>& times, const Nodes& own, const Nodes& other,
                                                               const Axes& axes) {
  LaneVec<Real> scaled, size, covector, rest, restSize;
  for (int k = 0; k < 3; ++k) {
    scaled[k] = own.normal[k] * axes.speed[k];
    size[k] = abs(scaled[k]);
  }
  for (int j = 0; j < 3; ++j) {
    covector[j] = scaled[0] * axes.matrix[0][j] + scaled[1] * axes.matrix[1][j] + scaled[2] * axes.matrix[2][j];
  }
  // The other's extent along the covector: its slab bounds the part along its normal, its box bounds the rest.
  const Lanes<Real> along = dot(covector, other.normal);
  for (int j = 0; j < 3; ++j) {
    rest[j] = covector[j] - along * other.normal[j];
    restSize[j] = abs(rest[j]);
  }
  const Lanes<Real> least = Real(kLeastSpeed<Real>);
  const Lanes<Real> middle =
      own.slabMiddle - dot(scaled, axes.offset) - along * other.slabMiddle - dot(rest, other.centre);
  const Lanes<Real> half = own.slabHalf + dot(size, axes.normalSlack) + abs(along) * other.slabHalf +
                           dot(restSize, other.half) + (least + least);
  const Lanes<Real> speed = scaled[0] + scaled[1] + scaled[2], inverse = Lanes<Real>(1) / max(abs(speed), least);
  cut(times, withSignOf(middle, speed) * inverse, half * inverse);
}

template <class Real>
Times<Real> NodeTest<Real>::operator()(const NodeLanes& nodesA, const NodeLanes& nodesB) const {
  Nodes a, b;
  a.loadBoxes(nodesA);
  b.loadBoxes(nodesB);
  Times<Real> times{-Real(INFINITY), Real(1)};
  cutByBox(times, a, b, alongA_);
  cutByBox(times, b, a, alongB_);
  if (!alongA_.complete || !alongB_.complete) return times;
  a.loadNormals(nodesA);
  b.loadNormals(nodesB);
  const Lanes<Real> left = times.to - max(times.from, Lanes<Real>(0));
  if (above(min(left, max(a.thinness(), b.thinness())), Lanes<Real>(0)) == 0) return times;
  cutByNormal(times, a, b, alongA_);
  cutByNormal(times, b, a, alongB_);
  return times;
}

template class NodeTest<float>;
template class NodeTest<double>;

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
