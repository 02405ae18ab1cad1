#include "cpu/leaf_test.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

/// The triangles of a leaf, in its mesh's normalised frame.
template <class Real>
struct Corners {
  LaneVec<double> first;  ///< corner 0
  LaneVec<Real> edge[3];

  /// `alternate`: the lanes hold triangles 0 1 0 1, else 0 0 1 1.
  Corners(const Mesh& mesh, const gpu::MeshNode& leaf, bool alternate) {
    const uint32_t* order = &mesh.tree.order[leaf.link & gpu::kLinkItem];
    const uint32_t* one = &mesh.indices[3 * size_t{order[0]}];
    const uint32_t* two = (leaf.link & gpu::kLinkPair) != 0 ? &mesh.indices[3 * size_t{order[1]}] : one;
    const auto scale = static_cast<float>(1 / mesh.unit);
    FourFloats corner[3][3];
    for (int i = 0; i < 3; ++i) {
      const float* p = &mesh.positions[3 * size_t{one[i]}];
      const float* q = &mesh.positions[3 * size_t{two[i]}];
      for (int k = 0; k < 3; ++k) {
        const FourFloats lanes = alternate ? FourFloats{p[k], q[k], p[k], q[k]} : FourFloats{p[k], p[k], q[k], q[k]};
        corner[i][k] = (lanes - static_cast<float>(mesh.origin[k])) * scale;
      }
    }
    for (int k = 0; k < 3; ++k) {
      first[k] = corner[0][k];
      for (int i = 0; i < 3; ++i) edge[i][k] = Lanes<Real>(corner[(i + 1) % 3][k]) - Lanes<Real>(corner[i][k]);
    }
  }
};

unsigned lanesOf(const gpu::MeshNode& a, const gpu::MeshNode& b) {
  const unsigned ofA = (a.link & gpu::kLinkPair) != 0 ? 0b1111 : 0b0101;
  return ofA & ((b.link & gpu::kLinkPair) != 0 ? 0b1111 : 0b0011);
}

/// Three times the error of an axis, and the clearance; and the speed to which lower ones are raised, which changes
/// positions by at most the error within the duration.
template <class Real>
struct Margin {
  Lanes<Real> width, speed;
  Margin(const Lanes<Real>& error, const Lanes<Real>& clearance, Real duration)
      : width(Lanes<Real>(3) * error + clearance), speed(error * Lanes<Real>(1 / duration)) {}
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
  unsigned possible(Real duration) const {
    return ~(above(from, Lanes<Real>(duration)) | above(from, to) | above(Lanes<Real>(Real(0)), to));
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
void LeafTest<Real>::showA(const gpu::MeshNode& leaf) {
  if (a_.leaf == &leaf) return;
  a_.leaf = &leaf;
  a_.size = 4 * edgeError_;
  const Corners<Real> own(meshA_, leaf, true);
  for (int k = 0; k < 3; ++k) {
    // In doubles, so that a small difference of two corners is precise.
    using D = Lanes<double>;
    const Vector& row = matrix_[k];
    a_.corner[k] = D(row[0]) * own.first[0] + D(row[1]) * own.first[1] + D(row[2]) * own.first[2];
    LaneVec<Real> lanes;
    for (int j = 0; j < 3; ++j) {
      lanes[j] = static_cast<Real>(row[j]);
      a_.size += 2 * static_cast<Real>(std::abs(row[j])) * leaf.halfExtent[j];
    }
    for (int i = 0; i < 3; ++i) a_.edge[i][k] = dot<Real>(lanes, own.edge[i]);
  }
  cross<Real>(a_.edge[0], a_.edge[1], a_.normal);
}

template <class Real>
void LeafTest<Real>::showB(const gpu::MeshNode& leaf) {
  if (b_.leaf == &leaf) return;
  b_.leaf = &leaf;
  b_.size = 4 * edgeError_;
  const Corners<Real> own(meshB_, leaf, false);
  for (int k = 0; k < 3; ++k) {
    b_.corner[k] = own.first[k];
    for (int i = 0; i < 3; ++i) b_.edge[i][k] = own.edge[i][k];
    b_.size += 2 * leaf.halfExtent[k];
  }
  cross<Real>(b_.edge[0], b_.edge[1], b_.normal);
}

template <class Real>
LeafTimes<Real> LeafTest<Real>::operator()(const gpu::MeshNode& a, const gpu::MeshNode& b, Real begin, Real end) {
  using L = Lanes<Real>;
  LeafTimes<Real> out{{-Real(INFINITY), Real(INFINITY)}, Real(0), lanesOf(a, b)};
  if (!usable_) return out;

  showA(a);
  showB(b);
  LaneVec<Real> gap, travel;  // gap: from corner 0 of A's triangle to that of B's; travel: of A per unit of time
  L gapSize = Real(0);
  for (int k = 0; k < 3; ++k) {
    const Lanes<double> moved = offset_[k] + double(begin) * travel_[k];
    gap[k] = rounded<Real>(b_.corner[k] - (a_.corner[k] + moved));
    gapSize = gapSize + abs(gap[k]);
    travel[k] = static_cast<Real>(travel_[k]);
  }
  const Real duration = std::max(Real(1 + 4 * kRounding<Real>) * (end - begin), Real(kLeastSpeed<Real>));
  const L reach = gapSize + L(a_.size + b_.size + duration * travelSize_);
  const L error = L(positionError_) + L(Real(32 * kRounding<Real>)) * reach;

  LaneVec<Real> alpha, beta;
  for (int k = 0; k < 3; ++k) {
    alpha[k] = dot<Real>(b_.edge[k], a_.normal);
    beta[k] = dot<Real>(a_.edge[k], b_.normal);
  }
  Collected<Real> collected;
  const L zero = Real(0), half = Real(0.5);
  const L lowB = min(zero, min(alpha[0], -alpha[2])), highB = max(zero, max(alpha[0], -alpha[2]));
  const Margin<Real> marginA(L(a_.size) * (L(a_.size) * error + L(2 * edgeError_) * reach),
                             L(a_.size * a_.size * clearance_), duration);
  collected.add(dot<Real>(a_.normal, gap) + half * (lowB + highB), half * (highB - lowB), dot<Real>(a_.normal, travel),
                marginA, 0);
  const L lowA = min(zero, min(beta[0], -beta[2])), highA = max(zero, max(beta[0], -beta[2]));
  const Margin<Real> marginB(L(b_.size) * (L(b_.size) * error + L(2 * edgeError_) * reach),
                             L(b_.size * b_.size * clearance_), duration);
  collected.add(dot<Real>(b_.normal, gap) - half * (lowA + highA), half * (highA - lowA), dot<Real>(b_.normal, travel),
                marginB, 1);
  out.possible &= collected.possible(duration);
  if (out.possible == 0) return out;

  const Margin<Real> margin(L(a_.size * b_.size) * error + L(edgeError_ * (a_.size + b_.size)) * reach,
                            L(a_.size * b_.size * clearance_), duration);
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
  out.times = {collected.from, collected.to};
  out.axis = collected.axis;
  return out;
}

template class LeafTest<float>;
template class LeafTest<double>;

}  // namespace radar::cpu
