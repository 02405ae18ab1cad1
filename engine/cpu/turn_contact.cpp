#include "cpu/turn_contact.h"

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

double turnToleranceOf(const Query& query, const Mesh& sensor, const TurnMotion& motion) {
  const Box box = boxOf(sensor, query.worldFromMesh.m);
  double size = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2], query.clearance});
  if (size == 0) size = motion.speedPast({});  // a bare point
  return std::min(query.tolerance.value_or(INFINITY), kTolerance * size);
}

TurnContact::TurnContact(const Query& query, const TurnMotion& motion, double tolerance)
    : BracketedContact(query, 1, 0), motion_(motion), tolerance_(tolerance) {}

void TurnContact::beginObject(const Vector& way) {
  drift_ = way;
  const double speed = motion_.speedPast(way);
  fine_ = speed > 0 ? std::min(tolerance_ / speed, 1.0) : 1;
}

/// Both triangles about a corner of b, divided by a power of two so that products neither over- nor underflow.
class TurnContact::Pair {
 public:
  Pair(const TurnContact& contact, const exact::PlacedPair& pair)
      : turning_(contact.motion_.turning()),
        start_(pair.a),
        resting_(pair.b),
        way_(minus(turning_.way(), contact.drift_)),
        clearance_(contact.query_.clearance) {
    double most = norm1(way_), arm = 0, radius = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector r = minus(start_[i], turning_.centre());
      circle_[i] = turning_.circleOf(start_[i]);
      from_[i] = minus(start_[i], resting_[0]);
      b_[i] = minus(resting_[i], resting_[0]);
      arm = std::max(arm, norm1(r));
      radius = std::max(radius, norm1(circle_[i].across));
      most = std::max({most, norm1(from_[i]), norm1(b_[i])});
    }
    radius = (1 + 0x1p-40) * radius + 0x1p-46 * arm;
    const double angle = turning_.angle();
    speed_ = (1 + 0x1p-40) * (norm1(way_) + angle * radius);
    most += std::min(2.0, angle) * radius + clearance_;
    bend_ = radius * angle * angle / 8;
    // Of a corner's place relative to the other triangle, of a bend's straight way, and of times.
    error_ = turning_.errorFor(arm, way_) + 16 * kUnit * (most + speed_);
    unit_ = std::scalbn(1.0, -std::clamp(std::ilogb(std::max(most, 0x1p-1000)), -1000, 1000));
    for (Vector& corner : b_) corner = scaled(unit_, corner);
    for (int i = 0; i < 3; ++i) edgeB_[i] = minus(b_[(i + 1) % 3], b_[i]);
    normalB_ = cross(edgeB_[0], edgeB_[1]);
  }

  double error() const { return error_; }
  double speed() const { return speed_; }
  double bend() const { return bend_; }

  exact::Triangle at(double s) const {
    const Turning::Angle angle = turning_.angleAt(s);
    exact::Triangle out;
    for (int i = 0; i < 3; ++i)
      out[i] = scaled(unit_, radar::along(from_[i], 1, Turning::by(circle_[i], angle, s, way_)));
    return out;
  }
  /// Of a time of `length`, at whose ends a is at `begin` and `end`, the part in which the triangles may be nearer than
  /// the clearance, less `depth`; of 1.
  TimeSpan possible(const exact::Triangle& begin, const exact::Triangle& end, double length, double depth) const {
    const double apart = unit_ * (clearance_ - depth + error_), bend = unit_ * bend_ * length * length;
    TimeSpan times;
    const auto along = [&](const Vector& n) {
      const double size = std::sqrt(dot(n, n));
      // Heights are sums of three terms of at most 4 |n|.
      // Along the axis nothing bends.
      const Vector side = cross(turning_.axis(), n);
      const double bent = bend * (std::sqrt(dot(side, side)) + size * 0x1p-48);
      const double room = size * apart + bent + size * 0x1p-47 + 0x1p-900;
      const Extent first(n, begin), last(n, end), resting(n, b_);
      cutBelow(times, resting.high - first.low + room, resting.high - last.low + room);
      cutBelow(times, first.high - resting.low + room, last.high - resting.low + room);
      return times.empty();
    };
    Vector edge[3];
    for (int i = 0; i < 3; ++i) edge[i] = minus(begin[(i + 1) % 3], begin[i]);
    const Vector normal = cross(edge[0], edge[1]);
    if (along(normalB_) || along(normal)) return times;
    for (int i = 0; i < 3; ++i) {
      for (int k = 0; k < 3; ++k) {
        if (along(cross(edge[i], edgeB_[k]))) return times;
      }
    }
    const Vector across = cross(normal, normalB_);
    const double sizes = dot(normal, normal) * dot(normalB_, normalB_);
    if (!(dot(across, across) > kParallel * sizes)) {
      // Within a plane in which both may lie.
      for (int i = 0; i < 3; ++i) {
        if (along(cross(normal, edge[i])) || along(cross(normalB_, edgeB_[i]))) return times;
      }
    }
    // Across the gap, where no axis above is: of corners that come within a clearance, of triangles without an area.
    if (clearance_ > 0 || isSliver(normal, edge) || isSliver(normalB_, edgeB_.data())) {
      along(separationOf(begin, b_).normal);
    }
    return times;
  }

  /// Whether they certainly cross, or are nearer than the clearance.
  bool certainlyMeet(const exact::Triangle& a) const {
    const double rounding = unit_ * error_ + 0x1p-46;
    if (clearance_ == 0) return exact::cross(a, b_, 2 * rounding);
    return unit_ * clearance_ > rounding && certainlyWithin(a, b_, {}, unit_ * clearance_ - rounding);
  }
  /// Exactly: whether they have a point in common at the start; or whether they certainly are within the clearance.
  bool meetAtStart() const {
    if (clearance_ > 0 && certainlyWithin(start_, resting_, {}, clearance_)) return true;
    const Translation still(Vector{}, {});
    exact::EarliestContact touching(still);
    touching.consider({}, {start_, resting_});
    return touching.found();
  }

  Separation separationAt(double s, const Vector& drift) const {
    const Turning::Angle angle = turning_.angleAt(s);
    exact::Triangle a = start_;
    for (int i = 0; i < 3; ++i) a[i] = radar::along(a[i], 1, Turning::by(circle_[i], angle, s, way_));
    Separation found = separationOf(a, resting_);
    found.point = radar::along(found.point, s, drift);
    return found;
  }

 private:
  const Turning& turning_;
  const exact::Triangle &start_, &resting_;
  const Vector way_;
  const double clearance_;
  Turning::Circle circle_[3];
  exact::Triangle from_, b_, edgeB_;
  Vector normalB_;
  double bend_, speed_, error_, unit_;  // world units, in 1 of s; bend: off a straight way
};

// Goes forward in steps: by as much of each as the triangles certainly stay apart.
std::optional<Approach> TurnContact::bracketOf(const exact::PairName&, const exact::PlacedPair& placed) {
  const Pair pair(*this, placed);
  // No finer than what rounding leaves.
  const double speed = pair.speed();
  const double fine = std::min(std::max({fine_, speed > 0 ? 8 * pair.error() / speed : 1.0, 0x1p-48}), 1.0);
  // In so short a step points bend off by less than they move in a fine one.
  const double straight = std::max(fine, std::sqrt(0.25 * fine * speed / std::max(pair.bend(), 0x1p-1000)));
  double lo = INFINITY;  // they have certainly not met before this
  double depth = 0;      // once they may have touched, only what is deeper matters
  double from = from_, step = to_ - from_;
  exact::Triangle begin = pair.at(from);
  const auto found = [&](double s) { return Approach{lo, s, pair.separationAt(lo, drift_)}; };
  while (from <= std::min(to_, latest())) {
    const double end = std::min(from + step, to_), length = end - from;
    const exact::Triangle last = pair.at(end);
    const TimeSpan times = pair.possible(begin, last, length, depth);
    if (times.empty()) {
      if (end == to_) break;
      from = end;
      begin = last;
      step = std::max(4 * step, fine);
      continue;
    }
    if (from == 0 && times.from == 0 && std::isinf(lo) && pair.meetAtStart()) {
      return Approach{0, 0, pair.separationAt(0, drift_)};
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
    depth = kShallow * tolerance_;
    if (end == to_) break;
    from = end;
    begin = last;
    step = std::max(4 * step, fine);
  }
  if (std::isinf(lo)) return std::nullopt;
  return Approach{lo, std::numeric_limits<double>::infinity(), {}};
}

}  // namespace radar::cpu
