#include "cpu/turn_motion.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

// Radians of a part, at most: its box is then at most an eighth larger than the sensor's.
constexpr double kMostAngle = 0.25;
// How far points may bend away from straight ways: as a share of the sensor's radius, or of the length of its edges.
constexpr double kBend = 0.05, kBendOfEdge = 0.5;
constexpr double kMostParts = 1 << 14;  // of some 700 bytes

double norm(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

// A point that is `radius` from the axis, in a part of which the angle is `by` and the straight motion `way`, and as
// seen from a body that turns: second derivatives, over 8.
double bendOf(double radius, double by) {
  return radius * by * by / 8;
}
double bendSeenFromBody(double radius, double by, double way) {
  return bendOf(radius + way, by) + by * way / 4;
}

}  // namespace

TurnMotion::TurnMotion(const Query& query, const Mesh& sensor) : turning_(query) {
  const Transform& pose = query.worldFromMesh;
  const Box box = boxOf(sensor, pose.m);
  Vector middle, half;
  for (int k = 0; k < 3; ++k) {
    middle[k] = box.middle(k);
    half[k] = box.hi[k] - middle[k];
  }
  const double reach = norm(half), arm = norm(minus(middle, turning_.centre())) + reach;
  radius_ = (1 + 0x1p-40) * (turning_.radius(middle) + reach + query.clearance) + 0x1p-40 * arm;
  const Vector& way = turning_.way();
  const double angle = turning_.angle(), length = norm(way);
  double edge = 0;
  for (int k = 0; k < 3; ++k) edge = std::max(edge, norm({pose.m[k], pose.m[4 + k], pose.m[8 + k]}) * sensor.meanEdge);
  const double allowed =
      std::max({std::min(kBend * reach, kBendOfEdge * edge), 0x1p-10 * reach, 0x1p-14 * (radius_ + length)});
  double count = std::ceil(angle / kMostAngle);
  while (count < kMostParts && bendSeenFromBody(radius_, angle / count, length / count) > allowed) count *= 1.5;
  count = std::min(std::ceil(count), kMostParts);

  double terms = norm(minus({pose.m[3], pose.m[7], pose.m[11]}, turning_.centre()));
  for (int k = 0; k < 3; ++k) terms += norm({pose.m[k], pose.m[4 + k], pose.m[8 + k]}) * sensor.span()[k];
  const double error = turning_.errorFor(terms, way) + 8 * kUnit * (terms + norm1(turning_.centre()) + norm1(way));
  const auto poseAt = [&](double s) { return turning_.pose(pose, s, way); };
  Transform last = pose;
  Vector lastMiddle = middle;
  parts_.reserve(static_cast<size_t>(count));
  for (double i = 0; i < count; ++i) {
    const double from = i / count, end = i + 1 < count ? (i + 1) / count : 1;
    const Transform next = poseAt(end);
    const Vector nextMiddle = along(middle, 1, turning_.displacement(middle, end, way));
    const MeshPlacement first(sensor, last), second(sensor, next);
    const double bend = bendOf(radius_, (1 + 0x1p-40) * angle * (end - from));
    TurnPart part{from, end, {first, second}, {MeshAxes(first.linear), MeshAxes(second.linear)}, bend, error, {}, {}};
    const Vector moved = minus(nextMiddle, lastMiddle);
    part.start = boxOf(sensor, last.m);
    Box other = boxOf(sensor, next.m);
    for (int k = 0; k < 3; ++k) {
      other.lo[k] -= moved[k];
      other.hi[k] -= moved[k];
    }
    part.start.merge(other);
    for (int k = 0; k < 3; ++k) {
      const double rounding = 16 * kUnit * (std::abs(moved[k]) + std::abs(middle[k]) + std::abs(nextMiddle[k]));
      part.start.lo[k] -= rounding;
      part.start.hi[k] += rounding;
    }
    const double straight = norm(moved);
    // Along another unit vector, at most as far as the middle moves.
    part.piece.unit = straight > 0x1p-500 ? scaled(1 / straight, moved) : Vector{1, 0, 0};
    part.piece.from = from;
    part.piece.end = end;
    part.piece.rate = (1 + 0x1p-40) * straight / (end - from) + 0x1p-1000;
    part.piece.deviation = (1 + 0x1p-40) * (2 * bend + 2 * error) + 0x1p-40 * straight + 0x1p-490;
    parts_.push_back(part);
    last = next;
    lastMiddle = nextMiddle;
  }
}

double TurnMotion::speedPast(const Vector& objectWay) const {
  return (1 + 0x1p-40) * (turning_.angle() * radius_ + norm(minus(turning_.way(), objectWay)));
}

double TurnMotion::bendSeen(const TurnPart& part, const Vector& objectWay) const {
  const double share = (1 + 0x1p-40) * (part.end - part.from);
  return bendSeenFromBody(radius_, turning_.angle() * share, norm(minus(turning_.way(), objectWay)) * share);
}

TurnPlacement::TurnPlacement(const Frame& frame) {
  for (int k = 0; k < 3; ++k) {
    slack[k] = 0;
    double magnitude = 4;
    for (int e = 0; e < 2; ++e) {
      const Vector& n = frame.axes[e]->rows[k];
      const MeshPlacement &own = *frame.own[e], &other = *frame.other[e];
      offset[e][k] = dot(n, frame.gap[e]);
      magnitude += std::abs(offset[e][k]);
      Vector rounding;
      for (int i = 0; i < 3; ++i) {
        rounding[i] = own.error[i] + other.error[i] + 0x1p-1000 +
                      32 * kUnit * (own.extent[i] + other.extent[i] + std::abs(frame.gap[e][i]));
      }
      for (int j = 0; j < 3; ++j) {
        matrix[e][k][j] = n[0] * other.linear[0][j] + n[1] * other.linear[1][j] + n[2] * other.linear[2][j];
        magnitude += 2 * std::abs(matrix[e][k][j]);
      }
      const double bent = (norm(cross(frame.axis, n)) + 0x1p-40 * norm(n)) * frame.bend;
      slack[k] = std::max(
          slack[k], 1.01 * (norm(n) * frame.apart + bent) + reachAlong(n, rounding) + 2 * frame.axes[e]->residual[k]);
    }
    slack[k] += 64 * kUnit * magnitude;
    if (!(magnitude < kMostMagnitude<double>)) slack[k] = INFINITY;
  }
}

TurnTest::Axes::Axes(const TurnPlacement& placement) {
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

struct TurnTest::Boxes {
  LaneVec<double> centre, half;

  explicit Boxes(const FourNodes& nodes) {
    for (int k = 0; k < 3; ++k) {
      const auto lanes = [&](const auto& of) {
        return FourFloats{of(*nodes[0]), of(*nodes[1]), of(*nodes[2]), of(*nodes[3])};
      };
      centre[k] = lanes([k](const gpu::MeshNode& node) { return node.centre[k]; });
      half[k] = lanes([k](const gpu::MeshNode& node) { return node.halfExtent[k]; });
    }
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
void TurnTest::cut(Times<double>& times, const Boxes& own, const Boxes& other, const Axes& axes) {
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

bool TurnTest::areApart(const TurnPlacement& fromOwn, const FourNodes& own, const FourNodes& other) {
  Times<double> times{0.0, 1.0};
  cut(times, Boxes(own), Boxes(other), Axes(fromOwn));
  return times.from[0] > times.to[0];
}

Times<double> TurnTest::operator()(const FourNodes& nodesA, const FourNodes& nodesB) const {
  const Boxes a(nodesA), b(nodesB);
  Times<double> times{0.0, 1.0};
  cut(times, a, b, alongA_);
  cut(times, b, a, alongB_);
  return times;
}

}  // namespace radar::cpu
