#include "cpu/leaf_test.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

namespace radar::cpu {

inline namespace RADAR_WIDTH {

namespace {

/// The triangles of leaves, in their mesh's normalised frame.
template <class Real>
struct Corners {
  LaneVec<double> first;  ///< corner 0
  LaneVec<Real> edge[3];

  /// `alternate`: the four lanes of a leaf hold triangles 0 1 0 1, else 0 0 1 1.
  Corners(const MeshTree& tree, const gpu::MeshNode* const (&leaves)[LeafPairs::kMost], bool alternate) {
    // All numbers of triangle 0, and of triangle 1 or 0 again, four at a time.
    Floats zero[3], one[3];
    for (int n = 0; n < 3; ++n) {
      FourFloats ofZero[LeafPairs::kMost], ofOne[LeafPairs::kMost];
      for (int m = 0; m < LeafPairs::kMost; ++m) {
        const float* const from = &tree.corners[9 * size_t{leaves[m]->link & gpu::kLinkItem} + 4 * n];
        std::memcpy(&ofZero[m], from, sizeof(FourFloats));
        std::memcpy(&ofOne[m], from + ((leaves[m]->link & gpu::kLinkPair) != 0 ? 9 : 0), sizeof(FourFloats));
      }
      zero[n] = joined(ofZero);
      one[n] = joined(ofOne);
    }
    Floats corner[3][3];
    const auto take = [&]<int n>(std::integral_constant<int, n>) {
      const Floats &x = zero[n / 4], &y = one[n / 4];
      corner[n / 3][n % 3] = alternate ? alternating<n % 4>(x, y) : twiceEach<n % 4>(x, y);
    };
    [&]<int... n>(std::integer_sequence<int, n...>) {
      (take(std::integral_constant<int, n>()), ...);
    }
    (std::make_integer_sequence<int, 9>());
    for (int k = 0; k < 3; ++k) {
      first[k] = corner[0][k];
      for (int i = 0; i < 3; ++i) edge[i][k] = Lanes<Real>(corner[(i + 1) % 3][k]) - Lanes<Real>(corner[i][k]);
    }
  }
};

unsigned lanesOf(const LeafPairs& pairs) {
  unsigned lanes = 0;
  for (int m = 0; m < pairs.count; ++m) {
    const unsigned ofA = (pairs.a[m]->link & gpu::kLinkPair) != 0 ? 0b1111 : 0b0101;
    const unsigned ofB = (pairs.b[m]->link & gpu::kLinkPair) != 0 ? 0b1111 : 0b0011;
    lanes |= (ofA & ofB) << (4 * m);
  }
  return lanes;
}

/// Returns whether they were others. Compares them one by one, since few do not pay for a call of memcmp().
bool replaceBy(const gpu::MeshNode* const (&leaves)[LeafPairs::kMost], const gpu::MeshNode* (&last)[LeafPairs::kMost]) {
  bool differ = false;
  for (int m = 0; m < LeafPairs::kMost; ++m) {
    differ |= last[m] != leaves[m];
    last[m] = leaves[m];
  }
  return differ;
}

template <class Real>
Lanes<Real> beginningOf(const LeafPairs& pairs) {
  Real near[LeafPairs::kMost] = {};
  std::copy(std::begin(pairs.near), std::end(pairs.near), near);
  return inFours(near);
}

/// Three times the error of an axis, and the clearance; and the speed to which lower ones are raised, which changes
/// positions by at most the error within the duration.
template <class Real>
struct Margin {
  Lanes<Real> width, speed;
  Margin(const Lanes<Real>& error, const Lanes<Real>& clearance, const Lanes<Real>& duration)
      : width(Lanes<Real>(3) * error + clearance), speed(error * (Lanes<Real>(1) / duration)) {}
};

/// Intersects the intervals of the axes. A NaN leaves the result unchanged.
template <class Real>
struct Collected {
  Lanes<Real> from = -Real(INFINITY), to = Real(INFINITY), axis = Real(0);

  /// Adds an axis: the pairs meet only at times t at which speed * t is within `half` of `middle`.
  void add(const Lanes<Real>& middle, const Lanes<Real>& half, const Lanes<Real>& speed, const Margin<Real>& margin,
           Axis number) {
    const Lanes<Real> inverse = Lanes<Real>(1) / max(abs(speed), margin.speed);
    const Lanes<Real> at = withSignOf(middle, speed) * inverse, wide = (half + margin.width) * inverse;
    const Lanes<Real> start = at - wide;
    axis = select(start, from, Lanes<Real>(Real(number)), axis);
    from = max(start, from);
    to = min(at + wide, to);
  }
  /// One bit per lane whose pair may meet by `duration`.
  unsigned possible(const Lanes<Real>& duration) const {
    return ~(above(from, duration) | above(from, to) | above(Lanes<Real>(Real(0)), to));
  }
};

template <class Real>
Lanes<Real> rounded(const Lanes<double>& x) {
  if constexpr (sizeof(Real) == sizeof(float)) {
    return x.floats();
  } else {
    return x;
  }
}

}  // namespace

template <class Real>
LeafTest<Real>::LeafTest(const Mesh& meshA, const Mesh& meshB, const RelativePlacement& relative)
    : meshA_(meshA), meshB_(meshB), matrix_(relative.matrix), offset_(relative.offset), travel_(relative.travel) {
  double position = 0, edge = 0, travelSize = 0, clearance = 0;
  for (int k = 0; k < 3; ++k) {
    travelSize += std::abs(travel_[k]);
    edge = std::max(edge, 2 * relative.rounding[k]);
    clearance = std::max(clearance, relative.slack[k] - relative.rounding[k]);
    position = std::max(position, 2 * relative.rounding[k] + 16 * kUnit * relative.magnitude[k]);
    usable_ = usable_ && relative.magnitude[k] + relative.slack[k] < kMostMagnitude<Real>;
  }
  if (!usable_) return;  // the numbers may not fit a float
  travelSize_ = static_cast<Real>(travelSize);
  positionError_ = static_cast<Real>(1.01 * position);
  edgeError_ = static_cast<Real>(1.01 * edge);
  clearance_ = static_cast<Real>(1.01 * clearance);
}

template <class Real>
void LeafTest<Real>::showA(const LeafPairs& pairs) {
  if (!replaceBy(pairs.a, a_.leaves)) return;
  const Corners<Real> own(meshA_.tree, pairs.a, true);
  Real size[LeafPairs::kMost];
  std::fill_n(size, LeafPairs::kMost, 4 * edgeError_);
  for (int k = 0; k < 3; ++k) {
    // In doubles, so that a small difference of two corners is precise.
    using D = Lanes<double>;
    const Vector& row = matrix_[k];
    a_.corner[k] = D(row[0]) * own.first[0] + D(row[1]) * own.first[1] + D(row[2]) * own.first[2];
    LaneVec<Real> lanes;
    for (int j = 0; j < 3; ++j) {
      lanes[j] = static_cast<Real>(row[j]);
      for (int m = 0; m < LeafPairs::kMost; ++m) {
        size[m] += 2 * static_cast<Real>(std::abs(row[j])) * pairs.a[m]->halfExtent[j];
      }
    }
    for (int i = 0; i < 3; ++i) a_.edge[i][k] = dot<Real>(lanes, own.edge[i]);
  }
  a_.size = inFours(size);
  cross<Real>(a_.edge[0], a_.edge[1], a_.normal);
}

template <class Real>
void LeafTest<Real>::showB(const LeafPairs& pairs) {
  if (!replaceBy(pairs.b, b_.leaves)) return;
  const Corners<Real> own(meshB_.tree, pairs.b, false);
  Real size[LeafPairs::kMost];
  std::fill_n(size, LeafPairs::kMost, 4 * edgeError_);
  for (int k = 0; k < 3; ++k) {
    b_.corner[k] = own.first[k];
    for (int i = 0; i < 3; ++i) b_.edge[i][k] = own.edge[i][k];
    for (int m = 0; m < LeafPairs::kMost; ++m) size[m] += 2 * pairs.b[m]->halfExtent[k];
  }
  b_.size = inFours(size);
  cross<Real>(b_.edge[0], b_.edge[1], b_.normal);
}

template <class Real>
LeafTimes<Real> LeafTest<Real>::timesOf(const LeafPairs& pairs, Real end) {
  using L = Lanes<Real>;
  LeafTimes<Real> out{-Real(INFINITY), Real(0), lanesOf(pairs)};
  if (!usable_) return out;

  showA(pairs);
  showB(pairs);
  const L begin = beginningOf<Real>(pairs);
  const Lanes<double> start = beginningOf<double>(pairs);
  LaneVec<Real> gap, travel;  // gap: from corner 0 of A's triangle to that of B's; travel: of A per unit of time
  L gapSize = Real(0);
  for (int k = 0; k < 3; ++k) {
    const Lanes<double> moved = offset_[k] + start * travel_[k];
    gap[k] = rounded<Real>(b_.corner[k] - (a_.corner[k] + moved));
    gapSize = gapSize + abs(gap[k]);
    travel[k] = static_cast<Real>(travel_[k]);
  }
  const L duration = max(Real(1 + 4 * kRounding<Real>) * (end - begin), L(Real(kLeastSpeed<Real>)));
  const L reach = gapSize + a_.size + b_.size + duration * travelSize_;
  const L error = L(positionError_) + L(Real(32 * kRounding<Real>)) * reach;

  LaneVec<Real> alpha, beta;
  for (int k = 0; k < 3; ++k) {
    alpha[k] = dot<Real>(b_.edge[k], a_.normal);
    beta[k] = dot<Real>(a_.edge[k], b_.normal);
  }
  Collected<Real> collected;
  const L zero = Real(0), half = Real(0.5);
  const L lowB = min(zero, min(alpha[0], -alpha[2])), highB = max(zero, max(alpha[0], -alpha[2]));
  const Margin<Real> marginA(a_.size * (a_.size * error + L(2 * edgeError_) * reach), a_.size * a_.size * clearance_,
                             duration);
  collected.add(dot<Real>(a_.normal, gap) + half * (lowB + highB), half * (highB - lowB), dot<Real>(a_.normal, travel),
                marginA, 0);
  const L lowA = min(zero, min(beta[0], -beta[2])), highA = max(zero, max(beta[0], -beta[2]));
  const Margin<Real> marginB(b_.size * (b_.size * error + L(2 * edgeError_) * reach), b_.size * b_.size * clearance_,
                             duration);
  collected.add(dot<Real>(b_.normal, gap) - half * (lowA + highA), half * (highA - lowA), dot<Real>(b_.normal, travel),
                marginB, 1);
  out.possible &= collected.possible(duration);
  if (out.possible == 0) return out;

  const Margin<Real> margin(a_.size * b_.size * error + edgeError_ * (a_.size + b_.size) * reach,
                            a_.size * b_.size * clearance_, duration);
  for (int i = 0; i < 3; ++i) {
    LaneVec<Real> gapAcross, travelAcross;
    cross<Real>(gap, a_.edge[i], gapAcross);
    cross<Real>(travel, a_.edge[i], travelAcross);
    for (int k = 0; k < 3; ++k) {
      const L halfA = (i == 1 ? -half : half) * alpha[k], halfB = (k == 1 ? -half : half) * beta[i];
      collected.add(dot<Real>(b_.edge[k], gapAcross) + halfA + halfB, abs(halfA) + abs(halfB),
                    dot<Real>(b_.edge[k], travelAcross), margin, 2 + 3 * i + k);
    }
    out.possible &= collected.possible(duration);
    if (out.possible == 0) return out;
  }
  out.from = begin + collected.from;
  out.axis = collected.axis;
  return out;
}

template class LeafTest<float>;
template class LeafTest<double>;

}  // namespace RADAR_WIDTH

}  // namespace radar::cpu
