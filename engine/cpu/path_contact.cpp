#include "cpu/path_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar::cpu {

namespace {

constexpr double kTolerance = 1e-6;  // of the longest side of the sensor's box, or of the clearance
// Of the tolerance: what gets no deeper may be left undecided.
constexpr double kShallow = 0.25;

// Of a step: one that leads farther is followed by one of what is left.
constexpr double kProgress = 0.125;
// The square of the sine between the planes of triangles that may lie in one.
constexpr double kParallel = 0x1p-30;
// The square of the sine between the edges of triangles that may have no area.
constexpr double kSliver = 0x1p-80;

/// Cuts off the times t at which a number is below 0 that changes evenly, from g0 at 0 to g1 at 1.
void cutBelow(TimeSpan& times, double g0, double g1) {
  if (g0 < 0) {
    times.from = g1 < 0 ? 2 : std::max(times.from, (1 - 4 * kUnit) * (g0 / (g0 - g1)));
  } else if (g1 < 0) {
    times.to = std::min(times.to, (1 + 4 * kUnit) * (g0 / (g0 - g1)));
  }
}

// Whether rounding may turn a triangle's normal anywhere.
bool isSliver(const Vector& normal, const Vector* edges) {
  return !(dot(normal, normal) > kSliver * dot(edges[0], edges[0]) * dot(edges[1], edges[1]));
}

struct Extent {
  double low, high;
  Extent(const Vector& n, const exact::Triangle& corners) {
    const double p = dot(n, corners[0]), q = dot(n, corners[1]), r = dot(n, corners[2]);
    low = std::min(p, std::min(q, r));
    high = std::max(p, std::max(q, r));
  }
};

}  // namespace

double pathToleranceOf(const Query& query, const Box& box, double speed) {
  double size = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2], query.clearance});
  if (size == 0) size = speed;  // a bare point
  return std::min(query.tolerance.value_or(INFINITY), kTolerance * size);
}

void PairPath::setUnit(double most) {
  unit_ = std::scalbn(1.0, -std::clamp(std::ilogb(std::max(most, 0x1p-1000)), -1000, 1000));
}

TimeSpan PairPath::possible(const Places& begin, const Places& end, double length, double depth) const {
  const double apart = unit_ * (clearance_ - depth + error_), bend = unit_ * bend_ * length * length;
  TimeSpan times;
  const auto along = [&](const Vector& n) {
    const double size = std::sqrt(dot(n, n));
    // Along the axis nothing bends.
    const Vector side = cross(axis_, n);
    const double bent = bend * (axis_ == Vector{} ? size : std::sqrt(dot(side, side)) + size * 0x1p-48);
    // Heights are sums of three terms of at most 4 |n|.
    const double room = size * apart + bent + size * 0x1p-47 + 0x1p-900;
    const Extent a0(n, begin.a), a1(n, end.a), b0(n, begin.b), b1(n, end.b);
    cutBelow(times, b0.high - a0.low + room, b1.high - a1.low + room);
    cutBelow(times, a0.high - b0.low + room, a1.high - b1.low + room);
    return times.empty();
  };
  Vector edge[3], edgeB[3];
  for (int i = 0; i < 3; ++i) {
    edge[i] = minus(begin.a[(i + 1) % 3], begin.a[i]);
    edgeB[i] = minus(begin.b[(i + 1) % 3], begin.b[i]);
  }
  const Vector normal = cross(edge[0], edge[1]), normalB = cross(edgeB[0], edgeB[1]);
  if (along(normalB) || along(normal)) return times;
  for (int i = 0; i < 3; ++i) {
    for (int k = 0; k < 3; ++k) {
      if (along(cross(edge[i], edgeB[k]))) return times;
    }
  }
  const Vector across = cross(normal, normalB);
  const double sizes = dot(normal, normal) * dot(normalB, normalB);
  if (!(dot(across, across) > kParallel * sizes)) {
    // Within a plane in which both may lie.
    for (int i = 0; i < 3; ++i) {
      if (along(cross(normal, edge[i])) || along(cross(normalB, edgeB[i]))) return times;
    }
  }
  // Across the gap, where no axis above is: of corners that come within a clearance, of triangles without an area.
  if (clearance_ > 0 || isSliver(normal, edge) || isSliver(normalB, edgeB)) {
    along(separationOf(begin.a, begin.b).normal);
  }
  return times;
}

bool PairPath::certainlyMeet(const Places& places) const {
  const double rounding = unit_ * error_ + 0x1p-46;
  if (clearance_ == 0) return exact::cross(places.a, places.b, 2 * rounding + unit_ * slack_);
  return unit_ * clearance_ > rounding && certainlyWithin(places.a, places.b, {}, unit_ * clearance_ - rounding);
}

void PathContact::setTolerance(double tolerance, double speed) {
  tolerance_ = 0.5 * tolerance;  // as a bracket may span two fine steps
  fine_ = speed > 0 ? std::min(tolerance_ / speed, 1.0) : 1;
}

std::optional<Approach> PathContact::bracket(const PairPath& pair) const {
  if (pair.slack() == 0) return bracket(pair, 0);
  // What is pressed together or rests is in contact without an end: first, whether it ever gets deep.
  auto found = bracket(pair, std::max(kShallow * tolerance_, 2 * pair.slack()));
  if (!found || found->hi == 0) return found;
  if (const auto earlier = bracket(pair, 2 * pair.slack())) {
    found->lo = std::min(found->lo, earlier->lo);
    if (earlier->hi <= found->hi) found = Approach{found->lo, earlier->hi, earlier->atLo};
  }
  return found;
}

// Goes forward in steps: by as much of each as the triangles certainly stay apart, or get no deeper than `depth`.
std::optional<Approach> PathContact::bracket(const PairPath& pair, double depth) const {
  // No finer than what rounding leaves.
  const double speed = pair.speed();
  const double fine = std::min(std::max({fine_, speed > 0 ? 8 * pair.error() / speed : 1.0, 0x1p-48}), 1.0);
  // In so short a step points bend off by less than they move in a fine one.
  const double straight = std::max(fine, std::sqrt(0.25 * fine * speed / std::max(pair.bend(), 0x1p-1000)));
  double lo = INFINITY;  // they have certainly not met before this
  PairPath::Start start = PairPath::Start::open;
  if (from_ == 0 && pair.slack() > 0) start = pair.atStart();
  if (start == PairPath::Start::meet) return Approach{0, 0, pair.separationAt(0)};
  double from = from_, step = to_ - from_;
  PairPath::Places begin = pair.at(from);
  const auto found = [&](double s) { return Approach{lo, s, pair.separationAt(lo)}; };
  // What may touch in time is followed to the end: its bracket must not depend on which pairs came before.
  while (from <= to_ && (from <= latest() || !std::isinf(lo))) {
    const double end = std::min(from + step, to_), length = end - from;
    const PairPath::Places last = pair.at(end);
    const TimeSpan times = pair.possible(begin, last, length, depth);
    if (times.empty()) {
      if (end == to_) break;
      from = end;
      begin = last;
      step = std::max(4 * step, fine);
      continue;
    }
    if (from == 0 && times.from == 0 && std::isinf(lo) && pair.slack() == 0 &&
        pair.atStart() == PairPath::Start::meet) {
      return Approach{0, 0, pair.separationAt(0)};
    }
    if (times.from > 0) {
      from += times.from * length;
      begin = pair.at(from);
    }
    step = std::max(end - from, 0.0);
    // By rounding a step may be a little longer than it was to be.
    const bool isFine = length <= 2 * fine;
    if (!isFine && (times.from > kProgress || step > 2 * straight)) {
      if (times.from <= kProgress) step = std::max(straight, step / 16);
      continue;
    }
    // Here they may meet.
    const double hi = std::min(from + fine, 1.0);
    if (pair.certainlyMeet(pair.at(hi))) {
      if (start == PairPath::Start::rest && hi <= 2 * fine) return Approach{0, 0, pair.separationAt(0)};
      lo = std::min(lo, from);
      if (hi - lo <= 2 * fine) return found(hi);
      // Found after a touch that may have been none: the earliest time at which they certainly meet.
      double early = lo, late = hi;
      while (late - early > fine) {
        const double middle = early + 0.5 * (late - early);
        (pair.certainlyMeet(pair.at(middle)) ? late : early) = middle;
      }
      return found(late);
    }
    if (!isFine) {
      step = std::max(fine, step / 16);
      continue;
    }
    lo = std::min(lo, from);
    // Once they may have touched, only what is deeper matters.
    depth = std::max(depth, kShallow * tolerance_);
    if (end == to_) break;
    from = end;
    begin = last;
    step = std::max(4 * step, fine);
  }
  if (std::isinf(lo)) return std::nullopt;
  return Approach{lo, std::numeric_limits<double>::infinity(), {}};
}

}  // namespace radar::cpu
