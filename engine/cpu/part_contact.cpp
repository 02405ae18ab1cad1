#include "cpu/part_contact.h"

#include <algorithm>
#include <cmath>

#include "cpu/parting_plane.h"
#include "math/rounding.h"

namespace radar::cpu {

namespace {

constexpr double kNever = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();
// Newton's steps converge quadratically, or by a factor of two where the way only grazes.
constexpr int kMostSteps = 60;
// Likewise of a way that passes by.
constexpr int kMostPasses = 12;
// Less than this of a vector is not told from 0.
constexpr double kNothing = 1e-14;
// Lengths are second-order in the angle of a normal.
constexpr double kAngle = 1e-9;

double lengthOf(const Vector& v) {
  return std::sqrt(dot(v, v));
}

double flatDot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1];
}

/// The least t for which a hull meets a triangle, over all t, below 0, too. It minimises the time at which the hull
/// meets a point, which is convex over the triangle: within its plane, else along the edges that face that place, else
/// at a corner. Normals and points found serve as proofs of bounds, so that nothing here need be exact.
class FirstTouch {
 public:
  FirstTouch(const HullMotion& motion, const exact::Triangle& corners, double error, double latest)
      : motion_(motion), hull_(motion.hull), way_(motion.way), corners_(corners), latest_(latest) {
    double size = hull_.size();
    for (const Vector& corner : corners_) size = std::max(size, norm1(corner));
    error_ = error + 32 * kUnit * size;
    fastest_ = lengthOf(way_);
  }

  void find();
  /// Looks for a plane that parts all of the way, where touches alone leave contact open.
  void part() { addPartingPlanes(motion_, corners_, error_, latest_, free_); }
  void offerNormal(const Vector& n) { free_.add(motion_, n, corners_, error_); }
  bool isFree() const { return free_.isFreeUntil(latest_); }
  bool isNarrow() const {
    return met < kNever && met - free_.until() <= 1e-12 * (std::abs(met) + error_ / (kUnit * fastest_));
  }
  const FreeTimes& free() const { return free_; }

  double met = kNever;  ///< they certainly meet then
  Vector weights{kNan, kNan, kNan};

 private:
  /// A point of the hull on the plane of the triangle at `t`, for a normal of length 1: returns the edges that keep it
  /// off the triangle.
  unsigned meetFace(const Vector& foot, const Vector& n, double t);
  void meetEdge(int k);
  void meetCorner(int k);
  /// A point, by the weights of the corners, that enters the hull at about `t`, probably on or beside the side to which
  /// these weights grow by `inwards`, if that is not 0.
  void offerPoint(Vector at, const Vector& inwards, double t);
  Vector mean(const Vector& at) const {
    return along(along(scaled(at[0], corners_[0]), at[1], corners_[1]), at[2], corners_[2]);
  }

  const HullMotion& motion_;
  const RingHull& hull_;
  const Vector& way_;
  const exact::Triangle& corners_;
  double latest_, error_ = 0, fastest_ = 0;
  unsigned seenCorners_ = 0;
  FreeTimes free_;
};

void FirstTouch::offerPoint(Vector at, const Vector& inwards, double t) {
  // Towards where it is certainly inside: later, and by as much aside where that alone would lead along the surface.
  const Vector aside = mean(inwards);
  const double length = lengthOf(aside);
  const bool isInTime = t <= latest_;
  struct Slope {
    double later, further, need;  ///< the point gets inside by these, and is to get inside by that
  } before{0, 0, 0};
  for (int i = 0; i < kMostSteps; ++i) {
    const bool isEnd = isInTime && t > latest_;
    if (isEnd) t = latest_;
    const RingHull::Foot foot = hull_.footOf(along(mean(at), -t, way_));
    const double need = foot.distance + error_ + (motion_.drift + 4 * kUnit * fastest_) * std::abs(t);
    if (need <= 0 && t < met) {
      met = t;
      weights = at;
    }
    if (need <= 0 || isEnd) return;
    const Slope now{dot(foot.normal, way_) / fastest_, length > 0 ? -dot(foot.normal, aside) / length : 0,
                    need + error_};
    const double squared = now.later * now.later + now.further * now.further;
    if (!(squared > kNothing)) return;
    double later = 1.5 * now.need * now.later / squared, further = 1.5 * now.need * now.further / squared;
    before.need -= before.later * later + before.further * further;
    if (before.need > 0) {
      // Out of this one's plane into the last one's: into both.
      before.need += before.later * later + before.further * further;
      const double across = now.later * before.further - now.further * before.later;
      if (std::abs(across) > kAngle) {
        later = (now.need * before.further - now.further * before.need) / across;
        further = (now.later * before.need - now.need * before.later) / across;
      }
    }
    t += later / fastest_;
    if (length > 0) at = along(at, further / length, inwards);
    before = {now.later, now.further, now.need - now.later * later - now.further * further};
    if (!(at[0] >= 0 && at[1] >= 0 && at[2] >= 0)) return;
  }
}

void FirstTouch::meetCorner(int k) {
  if ((seenCorners_ >> k & 1) != 0) return;
  seenCorners_ |= 1u << k;
  const Vector& p = corners_[k];
  // The hull is behind a plane through the point across the way until then.
  double t = (dot(way_, p) - hull_.support(way_)) / (fastest_ * fastest_);
  // The hull's surface nearest to the point: at two times, and how fast the point gets past a plane along it.
  struct Side {
    double t;
    Vector normal;
    double speed;
  } before{t, way_, fastest_ * fastest_}, now = before;
  for (int i = 0; i < kMostSteps; ++i) {
    const RingHull::Foot foot = hull_.footOf(along(p, -t, way_));
    before = now;
    now = {t, foot.normal, dot(foot.normal, way_)};
    if (foot.distance <= 0.25 * error_ || now.speed <= kNothing * fastest_) break;
    t += foot.distance / now.speed;
  }
  offerNormal(before.normal);
  offerNormal(now.normal);
  if (isFree()) return;
  if (now.speed > kNothing * fastest_) {
    Vector at{};
    at[k] = 1;
    return offerPoint(at, {}, t);
  }
  // It passes by. A plane along the way may tell that all of the triangle does.
  for (int i = 0; i < kMostPasses; ++i) {
    offerNormal(along(scaled(-now.speed, before.normal), before.speed, now.normal));
    const double share = before.speed / (before.speed - now.speed), then = before.t + share * (now.t - before.t);
    if (isFree() || !(then > before.t && then < now.t)) return;
    const RingHull::Foot foot = hull_.footOf(along(p, -then, way_));
    const Side between{then, foot.normal, dot(foot.normal, way_)};
    (between.speed > 0 ? before : now) = between;
  }
}

/// Where the shadow of a hull along an edge is met by a line: the best normal across the edge.
class EdgeTouch {
 public:
  /// `from`: a point of the edge; `edge`, of length 1, is not along the way.
  /// `error`: by less than this a line that misses the hull may seem to touch it.
  EdgeTouch(const RingHull& hull, const Vector& from, const Vector& edge, const Vector& way, double error)
      : hull_(hull), from_(from), edge_(edge), way_(way), error_(error) {
    forward_ = way;
    for (int i = 0; i < 2; ++i) {  // the first may lose most digits
      const Vector rest = along(forward_, -dot(forward_, edge), edge);
      forward_ = scaled(1 / lengthOf(rest), rest);
    }
    aside_ = radar::cross(edge, forward_);
    at_ = dot(aside_, from);
    flat_ = std::sqrt(flatDot(aside_, aside_));
    if (!(at_ < hull.support(aside_) + error && -at_ < hull.support(scaled(-1, aside_)) + error)) return;
    // Each normal is a bound, and the true one is among them.
    for (size_t i = 0; i < hull.rings().size(); ++i) offerRing(i);
    for (const RingHull::Side& side : hull.sides()) {
      if (side.outwards == 0) {
        offerEnd(side);
      } else {
        offerSide(side);
      }
    }
  }

  /// Whether its line ever meets the hull.
  bool isFound() const { return t_ > -kNever; }
  double t() const { return t_; }
  const Vector& normal() const { return normal_; }
  /// Where along the edge from its point. `length`: of the edge, some of which should be touched.
  double place(double length) const;
  const Vector& aside() const { return aside_; }

 private:
  enum class By { ring, side, end };
  void offer(const Vector& n, By by, size_t lower = 0, size_t upper = 0) {
    const double speed = dot(n, way_);
    if (!(speed > 0)) return;
    // As much less as rounding may make of it where the way is almost along the plane.
    const double t = (dot(n, from_) - hull_.support(n) - lengthOf(n) * error_) / speed;
    if (!(t > t_)) return;
    t_ = t;
    normal_ = n;
    by_ = by;
    lower_ = lower;
    upper_ = upper;
  }
  void offerRing(size_t ring);
  void offerSide(const RingHull::Side& side);
  void offerEnd(const RingHull::Side& side) {
    const Vector up{0, 0, side.up};
    offer(along(up, -dot(up, edge_), edge_), By::end);
  }

  const RingHull& hull_;
  const Vector &from_, &edge_, &way_;
  double error_;
  Vector forward_{}, aside_{};  // across the edge: normals are of these, with a positive share of the first
  double at_ = 0, flat_ = 0;
  double t_ = -kNever;
  Vector normal_{};
  By by_ = By::ring;
  size_t lower_ = 0, upper_ = 0;
};

void EdgeTouch::offerRing(size_t index) {
  const Ring& ring = hull_.rings()[index];
  const double aim = at_ - aside_[2] * ring.height, span = ring.radius * flat_ + ring.corner;
  if (!(std::abs(aim) < span)) return;
  if (ring.corner == 0) {
    // A circle's shadow is an ellipse: the two points of the circle that the edge meets.
    const double share = aim / span, rest = std::sqrt((1 - share) * (1 + share));
    const double x = aside_[0] / flat_, y = aside_[1] / flat_;
    for (const double sign : {1.0, -1.0}) {
      const Vector tangent{-(share * y + sign * rest * x), share * x - sign * rest * y, 0};
      Vector n = radar::cross(edge_, tangent);
      n = along(n, -dot(n, edge_), edge_);
      offer(dot(n, way_) < 0 ? scaled(-1, n) : n, By::ring);
    }
    return;
  }
  // The height of the farthest point over the edge grows along with the sine of the normal's angle.
  double sine = aim / span, least = -1, most = 1, last = 4;
  Vector n = forward_;
  for (int i = 0; i < kMostSteps; ++i) {
    const double cosine = std::sqrt((1 - sine) * (1 + sine));
    Vector turned;
    for (int k = 0; k < 3; ++k) {
      n[k] = cosine * forward_[k] + sine * aside_[k];
      turned[k] = cosine * aside_[k] - sine * forward_[k];
    }
    if (ring.radius == 0) break;
    const double side = std::sqrt(flatDot(n, n)), perSide = side > 0 ? 1 / side : 0;
    const double ofAside = flatDot(aside_, n) * perSide, ofTurned = flatDot(turned, n) * perSide;
    const double miss = aim - ring.radius * ofAside - ring.corner * sine;
    (miss > 0 ? least : most) = sine;
    const double bend = ring.radius * perSide * (flatDot(aside_, turned) - ofAside * ofTurned);
    double step = miss / (bend / cosine + ring.corner);
    const bool isGood = sine + step > least && sine + step < most && std::abs(step) < 0.5 * last;
    if (!isGood) step = 0.5 * least + 0.5 * most - sine;
    last = std::abs(step);
    sine += step;
    if (std::abs(step) <= kAngle) break;
  }
  offer(n, By::ring);
}

void EdgeTouch::offerSide(const RingHull::Side& side) {
  // Of the two normals across the edge that are as steep as the side's.
  const double x = forward_[2], y = aside_[2], squared = x * x + y * y, root = squared - side.up * side.up;
  if (!(root >= 0 && squared > 0)) return;
  for (const double sign : {1.0, -1.0}) {
    const double cosine = side.up * x - sign * y * std::sqrt(root), sine = side.up * y + sign * x * std::sqrt(root);
    if (!(cosine > 0)) continue;
    Vector n;
    for (int k = 0; k < 3; ++k) n[k] = (cosine * forward_[k] + sine * aside_[k]) / squared;
    offer(n, By::side, side.lower, side.upper);
  }
}

double EdgeTouch::place(double length) const {
  const auto placeOf = [&](const Vector& x) { return dot(along(x, t_, way_), edge_) - dot(from_, edge_); };
  if (by_ == By::end && flatDot(normal_, normal_) <= kAngle * kAngle * dot(normal_, normal_)) {
    // The nearest to the axis is on the flat end if any is.
    const Vector then = along(from_, -t_, way_);
    const double squared = flatDot(edge_, edge_);
    return squared > 0 ? -flatDot(then, edge_) / squared : 0.5 * length;
  }
  // Rings above each other, or an end and the ring beside it, may have led to the same normal.
  if (by_ != By::side) return placeOf(hull_.farthest(hull_.ringAlong(normal_), normal_));
  const Vector lower = hull_.farthest(lower_, normal_);
  const Vector upper = hull_.farthest(upper_, normal_);
  const double below = dot(aside_, lower) - at_, above = dot(aside_, upper) - at_, from = placeOf(lower),
               to = placeOf(upper);
  // Along the side, more than a point may touch.
  if (std::abs(above - below) <= kAngle * length) {
    return 0.5 * std::clamp(from, 0.0, length) + 0.5 * std::clamp(to, 0.0, length);
  }
  return from + std::clamp(below / (below - above), 0.0, 1.0) * (to - from);
}

void FirstTouch::meetEdge(int k) {
  const Vector &from = corners_[k], &to = corners_[(k + 1) % 3];
  const Vector span = minus(to, from);
  const double length = lengthOf(span);
  if (!(length > 0)) return meetCorner(k);
  const Vector edge = scaled(1 / length, span);
  if (lengthOf(radar::cross(edge, way_)) <= kNothing * fastest_) {
    meetCorner(k);
    return meetCorner((k + 1) % 3);
  }
  const EdgeTouch touch(hull_, from, edge, way_, error_);
  if (!touch.isFound()) {
    offerNormal(touch.aside());
    offerNormal(scaled(-1, touch.aside()));
    if (isFree()) return;
    meetCorner(k);
    return meetCorner((k + 1) % 3);
  }
  offerNormal(touch.normal());
  if (isFree()) return;
  const double place = touch.place(length);
  if (place <= 0) return meetCorner(k);
  if (place >= length) return meetCorner((k + 1) % 3);
  Vector at{}, onwards{};
  at[(k + 1) % 3] = place / length;
  at[k] = 1 - place / length;
  onwards[(k + 1) % 3] = 1;
  onwards[k] = -1;
  offerPoint(at, onwards, touch.t());
}

unsigned FirstTouch::meetFace(const Vector& foot, const Vector& n, double t) {
  const auto weightsOf = [&](const Vector& p) {
    Vector at;
    for (int k = 0; k < 3; ++k) {
      const Vector in = radar::cross(n, minus(corners_[(k + 1) % 3], corners_[k]));
      at[(k + 2) % 3] = dot(in, minus(p, corners_[k])) / dot(in, minus(corners_[(k + 2) % 3], corners_[k]));
    }
    return scaled(1 / (at[0] + at[1] + at[2]), at);
  };
  const Vector at = weightsOf(along(foot, t, way_));
  unsigned beyond = 0;
  for (int k = 0; k < 3; ++k) beyond |= !(at[(k + 2) % 3] >= 0) ? 1u << k : 0;
  if (beyond == 0) offerPoint(at, minus(weightsOf(along({0, 0, hull_.middle()}, t, way_)), at), t);
  return beyond;
}

void FirstTouch::find() {
  const Vector x = minus(corners_[1], corners_[0]), y = minus(corners_[2], corners_[0]);
  Vector n = radar::cross(x, y);
  const double area = lengthOf(n);
  unsigned edges = 0b111;
  if (area > 0) {
    n = scaled((dot(n, way_) < 0 ? -1 : 1) / area, n);
    const double speed = dot(n, way_);
    offerNormal(n);
    if (isFree()) return;
    if (speed > kNothing * fastest_) {
      const double support = hull_.support(n), t = (dot(n, corners_[0]) - support) / speed;
      edges = meetFace(hull_.farthest(hull_.ringAlong(n), n), n, t);
      // Where a flat end touches, so does its middle.
      const Vector middle{0, 0, std::abs(n[2]) > 0.5 ? support / n[2] : 0};
      if (edges != 0 && middle[2] != 0 && hull_.footOf(middle).distance <= error_) edges = meetFace(middle, n, t);
    } else {
      offerNormal(scaled(-1, n));
      if (isFree()) return;
    }
  }
  // Those that face the place; the others if that does not suffice.
  for (const unsigned which : {edges, 0b111 & ~edges}) {
    for (int k = 0; k < 3; ++k) {
      if ((which >> k & 1) != 0) meetEdge(k);
      if (isFree()) return;
    }
    if (isNarrow()) return;
  }
}

}  // namespace

void FreeTimes::add(const HullMotion& motion, const Vector& n, double least, double error) {
  const double length = lengthOf(n), speed = dot(n, motion.way);
  const double room = least - motion.hull.support(n) - length * error;
  const double astray = length * (motion.drift + 4 * kUnit * lengthOf(motion.way));
  if (room > 0) {
    const double nearing = speed + astray, t = nearing > 0 ? (1 - 8 * kUnit) * (room / nearing) : kNever;
    if (!(t > until_)) return;
    until_ = t;
    normal_ = scaled(1 / length, n);
  } else if (const double leaving = -speed - astray; leaving > 0) {
    after_ = std::min(after_, (1 + 8 * kUnit) * (-room / leaving));
  }
}

std::optional<PartContact> contactOf(const HullMotion& motion, const exact::Triangle& corners, double error,
                                     double latest) {
  FirstTouch touch(motion, corners, error, latest);
  touch.find();
  if (!touch.isFree() && !(touch.met <= latest) && !touch.isNarrow()) touch.part();
  if (touch.isFree()) return std::nullopt;
  PartContact out{touch.free().until(), touch.met, touch.weights, touch.free().normal()};
  if (out.hi <= 0) {
    // Contact has begun before the start. It has not ended if the last one is later.
    const HullMotion back{motion.hull, scaled(-1, motion.way), motion.drift};
    FirstTouch last(back, corners, error, kNever);
    last.find();
    touch.offerNormal(last.free().normal());
    if (!touch.isFree() && last.met > 0) touch.part();
    if (touch.isFree()) return std::nullopt;
    out.lo = 0;
    out.hi = last.met <= 0 ? 0 : kNever;
    // A point that enters now, between one that has and one that will leave.
    const double whole = touch.met + last.met, share = whole < 0 ? touch.met / whole : 0;
    out.weights = along(scaled(1 - share, touch.weights), share, last.weights);
  }
  if (out.normal == Vector{}) out.normal.fill(kNan);
  return out;
}

}  // namespace radar::cpu
