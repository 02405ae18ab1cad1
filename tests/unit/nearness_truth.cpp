#include "nearness_truth.h"

#include <sstream>

#include "blocking_oracle.h"
#include "exact/translation.h"
#include "nearness_oracle.h"
#include "workloads/vectors.h"

namespace oracle {

namespace {

using Real = long double;
using Point = distances::Point<Real>;
using Points = distances::Points<Real>;
using radar::Status;

const Real kNever = distances::kFar<Real>;

/// When the origin, moving by t along a unit vector, first enters the sum of b - a and a ball of radius r > 0, which it
/// is outside: at a piece of a sphere around the difference of two corners, of a cylinder around that of a corner and
/// an edge, or of a plane beside that of a face and a corner or of two edges.
class Entry {
 public:
  Entry(const Point& unit, const Real& r) : unit_(unit), r_(r) {}

  void sphere(const Point& p) {
    const Real middle = unit_.dot(p);
    enter(middle, (p - middle * unit_).squaredNorm(), 1);
  }
  void cylinder(const Point& p, const Point& edge) {
    const Real square = edge.squaredNorm();
    if (square == 0) return;
    const Point across = p - (p.dot(edge) / square) * edge, way = unit_ - (unit_.dot(edge) / square) * edge;
    const Real speed = way.squaredNorm();
    if (speed < 1e-30L) return;
    const Real middle = way.dot(across) / speed;
    enter(middle, (across - middle * way).squaredNorm(), speed, [&](const Real& t) {
      const Real share = (t * unit_ - p).dot(edge) / square;
      return share >= 0 && share <= 1;
    });
  }
  void plane(const Point& p, const Point& x, const Point& y, bool isTriangle) {
    const Point n = x.cross(y);
    const Real square = n.squaredNorm(), speed = n.dot(unit_);
    // Spheres and cylinders are as good where the sides are nearly parallel.
    if (square <= 1e-24L * x.squaredNorm() * y.squaredNorm() || speed == 0) return;
    for (const int side : {-1, 1}) {
      const Real t = (n.dot(p) + Real(side) * r_ * std::sqrt(square)) / speed;
      const Point at = t * unit_ - p;
      const Real v = at.cross(y).dot(n) / square, w = x.cross(at).dot(n) / square;
      if (v >= 0 && w >= 0 && (isTriangle ? v + w <= 1 : v <= 1 && w <= 1)) offer(t);
    }
  }
  const Real& first() const { return first_; }

 private:
  void enter(const Real& middle, const Real& square, const Real& speed) {
    enter(middle, square, speed, [](const Real&) { return true; });
  }
  template <class Counts>
  void enter(const Real& middle, const Real& square, const Real& speed, const Counts& counts) {
    const Real spare = r_ * r_ - square;
    if (spare < 0) return;
    const Real t = middle - std::sqrt(spare / speed);
    if (counts(t)) offer(t);
  }
  void offer(const Real& t) {
    if (t >= 0) first_ = std::min(first_, t);
  }

  const Point& unit_;
  const Real& r_;
  Real first_ = kNever;
};

/// When triangle a, moving along a unit vector or at rest, is first within r of b. `start`: their distance.
Real firstWithin(const Points& a, const Points& b, const Point& unit, const Real& start, const Real& r) {
  if (r < 0) return kNever;
  if (start <= r) return 0;
  if (unit.isZero(0) || r == 0) return kNever;
  Entry entry(unit, r);
  for (size_t i = 0; i < 3; ++i) {
    const Point x = a[(i + 1) % 3] - a[i];
    for (size_t k = 0; k < 3; ++k) {
      const Point p = b[k] - a[i], y = b[(k + 1) % 3] - b[k];
      entry.sphere(p);
      entry.cylinder(p, y);
      entry.cylinder(p, -x);
      entry.plane(p, -x, y, false);
    }
    entry.plane(b[0] - a[i], b[1] - b[0], b[2] - b[0], true);
    entry.plane(b[i] - a[0], a[0] - a[1], a[0] - a[2], true);
  }
  return entry.first();
}

/// Whether boxes around the triangles come within r of each other for 0 <= t <= end.
bool mayComeWithin(const Points& a, const Points& b, const Point& unit, const Real& end, const Real& r) {
  Real from = 0, to = end;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const auto [lowA, highA] = std::minmax({a[0][k], a[1][k], a[2][k]});
    const auto [lowB, highB] = std::minmax({b[0][k], b[1][k], b[2][k]});
    Real first = lowB - highA - r, last = highB - lowA + r;
    if (unit[k] == 0) {
      if (first > 0 || last < 0) return false;
      continue;
    }
    first /= unit[k];
    last /= unit[k];
    from = std::max(from, std::min(first, last));
    to = std::min(to, std::max(first, last));
  }
  return from <= to * (1 + 1e-15L) + r * 1e-15L;
}

std::string textOf(const Real& value) {
  std::ostringstream text;
  text.precision(18);
  text << value;
  return text.str();
}

/// Whether the triangles have a point in common.
bool touchesNow(const Corners& a, const Corners& b) {
  const auto met = contact(a, b, {1, 0, 0});
  return met && met->first.sign() <= 0 && met->last.sign() >= 0;
}

}  // namespace

NearTruth::NearTruth(const radar::Scene& scene, const radar::Query& query)
    : scene_(scene),
      query_(query),
      origin_(distances::pointOf<Real>(corners(scene.mesh(query.mesh), query.worldFromMesh, 0)[0])),
      end_(query.motion ? 1 : query.distance) {
  const auto enlarge = [&](const radar::MeshView& mesh, const radar::Transform& pose) {
    for (uint32_t i = 0; i < mesh.triangleCount(); ++i) {
      for (Point p : distances::pointsOf<Real>(corners(mesh, pose, i))) {
        size_ = std::max(size_, (p - origin_).cwiseAbs().maxCoeff());
      }
    }
  };
  enlarge(scene.mesh(query.mesh), query.worldFromMesh);
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (takesPart(scene, query, id)) enlarge(scene.mesh(scene.object(id).mesh), scene.object(id).worldFromMesh);
  }
  size_ = std::max(size_, Real(query.clearance));
  room_ = 1e-13L * size_;
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!takesPart(scene, query, id)) continue;
    if (query.skipOverlapping && surfacesCross(scene, query, id)) {
      overlapping_.push_back(id);
    } else {
      add(id);
    }
  }
}

/// A pair, its course, the slack and the clearance, in integers.
struct NearTruth::Exact {
  Faced a, b;
  IntVec direction;
  oracle::Course course;
  Integer slack, clearance;

  Exact(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id, const Corners& placedA,
        const Corners& placedB) {
    const double room = slackOf(scene, query, id);
    std::vector<double> all{room, query.clearance};
    for (const Corners* t : {&placedA, &placedB}) {
      for (const Corner& c : *t) all.insert(all.end(), c.begin(), c.end());
    }
    const int scale = leastExponent(all.data(), all.size());
    a = faced(scaled(placedA, scale), isMirrored(query.worldFromMesh));
    b = faced(scaled(placedB, scale), isMirrored(scene.object(id).worldFromMesh));
    const Corner way = directionPast(scene, query, id);
    direction = scaled(way, leastExponent(way.data(), 3));
    const bool step = isStep(scene, query);
    const radar::Translation motion = step ? radar::Translation(way, {}) : radar::Translation(query);
    course = courseOf(step ? way : motion.direction, motion.end, motion.length, scale);
    slack = scaled(room, scale);
    clearance = scaled(query.clearance, scale);
  }

  /// Whether they are pressed together, and rounding has not left them a way to go.
  bool areSunk() const {
    if (!arePressed(a, b, course, slack)) return false;
    const auto met = contact(a.corners, b.corners, direction);
    return !met || met->first.sign() <= 0;
  }
};

/// By the definition in docs/exact.md, "With a clearance". Numbers that are rounded decide what they can.
bool NearTruth::blocks(const Corners& a, const Corners& b, const Course& course, const Pair& pair) const {
  const Real slack = slackOf(scene_, query_, course.object), clearance = query_.clearance, rounding = 1e-16L * size_;
  if (pair.start > slack + rounding && clearance > slack) {
    const Real near = std::min(pair.start, clearance) - slack;
    if (firstWithin(pair.a, pair.b, course.unit, pair.start, near - rounding) < kNever) return true;
    if (firstWithin(pair.a, pair.b, course.unit, pair.start, near + rounding) >= kNever) return false;
  }
  const Exact exact(scene_, query_, course.object, a, b);
  if (exact.clearance > exact.slack && pair.start > 0) {
    const Nearness nearness = nearnessOf(exact.a.corners, exact.b.corners, exact.direction);
    if (nearness.start.num > exact.slack * exact.slack * nearness.start.den)
      return comesNearer(nearness, exact.clearance, exact.slack);
  }
  return oracle::blocks(exact.a, exact.b, exact.course, exact.slack);
}

void NearTruth::add(radar::ObjectId id) {
  const radar::Object& object = scene_.object(id);
  const radar::MeshView sensor = scene_.mesh(query_.mesh), mesh = scene_.mesh(object.mesh);
  const bool step = isStep(scene_, query_);
  const Point way = distances::pointOf<Real>(directionPast(scene_, query_, id));
  const Real length = way.norm(), whole = step ? length : query_.distance;
  const Point unit = length > 0 ? Point(way / length) : way;
  const Real longest = radar::tools::boundsOf(sensor, query_.worldFromMesh).longest();
  const Real usual = 1e-6L * std::max(longest, Real(query_.clearance));
  const Course course{id, unit, whole,
                      !step       ? 1
                      : whole > 0 ? end_ / whole
                                  : 0,
                      std::min(Real(query_.tolerance.value_or(usual)), usual) + 1e-11L * size_};
  std::vector<Corners> placedA, placedB;
  for (uint32_t i = 0; i < sensor.triangleCount(); ++i) placedA.push_back(corners(sensor, query_.worldFromMesh, i));
  for (uint32_t i = 0; i < mesh.triangleCount(); ++i) placedB.push_back(corners(mesh, object.worldFromMesh, i));
  const auto relative = [&](const Corners& placed) {
    Points out = distances::pointsOf<Real>(placed);
    for (Point& p : out) p -= origin_;
    return out;
  };
  std::vector<Points> a, b;
  for (const Corners& t : placedA) a.push_back(relative(t));
  for (const Corners& t : placedB) b.push_back(relative(t));
  const Real clearance = query_.clearance;
  // A step may be one of no distance.
  const auto inTime = [&](const Real& after) { return after <= whole ? Real(after * course.rate) : kNever; };
  // What is pressed together may have sunk in by the slack.
  const Real slack = query_.ignoreLeaving ? Real(slackOf(scene_, query_, id)) : 0, reach = std::max(clearance, slack);
  for (uint32_t k = 0; k < b.size(); ++k) {
    for (uint32_t i = 0; i < a.size(); ++i) {
      if (!mayComeWithin(a[i], b[k], unit, whole, reach + room_)) continue;
      Pair pair{courses_.size(), k, i, a[i], b[k], distances::distance(a[i], b[k]), 0, 0, false};
      pair.early = inTime(firstWithin(a[i], b[k], unit, pair.start, clearance + room_));
      const bool maySink = query_.ignoreLeaving && pair.start <= slack + room_;
      if (pair.early > end_ && !maySink) continue;
      pair.touches = pair.start <= room_ && touchesNow(placedA[i], placedB[k]);
      if (pair.touches) pair.start = 0;
      const bool isPressed = maySink && Exact(scene_, query_, id, placedA[i], placedB[k]).areSunk();
      if (!isPressed && pair.early > end_) continue;
      if (query_.ignoreLeaving && !isPressed && !blocks(placedA[i], placedB[k], course, pair)) {
        ++passing_;
        continue;
      }
      pair.late = inTime(firstWithin(a[i], b[k], unit, pair.start, clearance - room_));
      if (pair.touches) pair.late = 0;
      if (isPressed) {
        pair.start = std::min(pair.start, clearance);
        pair.early = pair.late = 0;
      }
      // A tiny clearance: what touches is within it.
      if (clearance <= 10 * room_ && pair.late > end_ && length > 0) {
        const auto met = contact(placedA[i], placedB[k], directionPast(scene_, query_, id));
        if (met && met->first.sign() >= 0) {
          const Rational s(met->first.num, met->first.den);
          pair.late = inTime(s.convert_to<Real>() * length + course.tolerance);
        }
      }
      pairs_.push_back(pair);
    }
  }
  courses_.push_back(course);
}

NearTruth::Span NearTruth::spanOf(radar::ObjectId id) const {
  Span span{kNever, kNever, kNever};
  for (const Pair& pair : pairs_) {
    if (id != radar::kNone && courses_[pair.course].object != id) continue;
    span.start = std::min(span.start, pair.start);
    span.early = std::min(span.early, pair.early);
    span.late = std::min(span.late, pair.late);
    const Course& course = courses_[pair.course];
    span.tolerance = std::max(span.tolerance, course.tolerance * course.rate);
  }
  for (const Pair& pair : pairs_) {
    if (id != radar::kNone && courses_[pair.course].object != id) continue;
    const Real until = std::min(span.late, end_);
    if (pair.early <= until + span.tolerance) span.isLoose |= pair.late - pair.early > 0.1L * span.tolerance;
  }
  return span;
}

bool NearTruth::isOpen() const {
  return std::ranges::any_of(pairs_, [&](const Pair& pair) {
    const Course& course = courses_[pair.course];
    return pair.late > end_ || pair.late - pair.early > 0.1L * course.tolerance * course.rate;
  });
}

std::string NearTruth::faultOfOne(const radar::Result& result, radar::ObjectId among, bool isDecision) const {
  const Span span = spanOf(among);
  const auto but = [&](const char* what) {
    return std::string(what) + "; contact begins from " + textOf(span.early) + " to " + textOf(span.late) +
           ", the least distance at the start is " + textOf(span.start);
  };
  const bool isCertain = span.late <= end_, isPossible = span.early <= end_;
  const Real clearance = query_.clearance;
  switch (result.status) {
    case Status::clear:
      return isCertain ? but("clear") : "";
    case Status::undecided:
      if (isCertain || !isPossible) return but("undecided");
      return result.lo <= span.late && result.hi == INFINITY ? "" : but("bounds of what is undecided");
    case Status::hit:
    case Status::overlap:
      break;
    default:
      return but("no answer");
  }
  if (!isPossible) return but("a contact");
  if (isDecision) {
    const double end = query_.motion ? 1 : query_.distance;
    const bool isHit = result.status == Status::hit && result.object == radar::kNone;
    return isHit && result.lo == 0 && result.t == end && result.hi == end ? "" : but("not a decision");
  }
  if (result.status == Status::overlap) {
    if (span.start > clearance + room_ || result.lo != 0 || result.t != 0 || result.hi != 0) return but("an overlap");
    return faultOfPlace(result, span, among);
  }
  if (span.start < clearance - room_) return but("a hit, not an overlap");
  if (!(0 <= result.lo && result.lo == result.t && result.t <= result.hi && result.hi <= end_))
    return but("bounds in disorder");
  if (result.hi < span.early || result.lo > span.late) return but("wrong bounds");
  if (result.hi > span.late + span.tolerance || result.lo < span.early - span.tolerance) return but("far bounds");
  if (!span.isLoose && result.hi - result.lo > span.tolerance) return but("wide bounds");
  return faultOfPlace(result, span, among);
}

std::string NearTruth::faultOfPlace(const radar::Result& result, const Span& span, radar::ObjectId among) const {
  const bool isStart = result.status == Status::overlap;
  const Pair *named = nullptr, *touching = nullptr;
  for (const Pair& pair : pairs_) {
    const radar::ObjectId id = courses_[pair.course].object;
    if (id == result.object && pair.triB == result.triB && pair.triA == result.triA) named = &pair;
    if (pair.touches && touching == nullptr && (among == radar::kNone || id == among)) touching = &pair;
  }
  if (named == nullptr) return "a pair that does not count";
  const Course& course = courses_[named->course];
  const bool step = isStep(scene_, query_);
  const Real gap = result.gap, way = step ? result.fraction * course.whole : result.t;
  const Point drift = distances::pointOf<Real>(scene_.object(course.object).motion);
  // Where another pair begins the bracket, those are of when the named one comes within the clearance.
  const Real share = end_ > 0 ? (Real(result.hi) - result.lo) / end_ : 1, later = share * (course.whole + drift.norm());
  const Real off = 4 * room_ + 1e-15L * origin_.cwiseAbs().maxCoeff() + (isStart ? 0 : later);
  if (isStart && named->start > span.start + room_) return "not the nearest pair";
  if (isStart && touching != nullptr && (named > touching || gap != 0)) return "not the least pair that touches";
  if (!isStart && named->early > result.hi) return "a pair that comes later";
  Points a = named->a;
  for (Point& p : a) p += way * course.unit;
  const Real distance = distances::distance(a, named->b);
  const Real sunk = query_.ignoreLeaving ? slackOf(scene_, query_, course.object) : 0;
  const Real most = room_ + (isStart ? std::max(Real(query_.clearance), sunk) : query_.clearance + course.tolerance);
  if (std::abs(distance - gap) > off || gap > most) return "gap " + textOf(gap) + ", not " + textOf(distance);
  if (std::isnan(result.point[0])) return "no point";
  Point point = distances::pointOf<Real>(result.point) - origin_;
  if (step) point -= Real(result.fraction) * drift;
  if (distances::fromTriangle(point, named->b) > off) return "a point off the object";
  if (std::isnan(result.normal[0])) return gap <= 4 * room_ ? "" : "no normal";
  const Point other = point + gap * distances::pointOf<Real>(result.normal);
  return distances::fromTriangle<Real>(other, a) <= off ? "" : "the sensor's point off the sensor";
}

std::string NearTruth::faultOfList(std::span<const radar::Result> hits) const {
  std::vector<bool> isListed(scene_.objectLimit());
  size_t certain = 0;
  Real last = -1;
  for (size_t i = 0; i < hits.size(); ++i) {
    const radar::Result& hit = hits[i];
    if (hit.object == radar::kNone || isListed.at(hit.object)) return "an object that is none, or listed twice";
    isListed[hit.object] = true;
    if (std::string fault = faultOfOne(hit, hit.object, false); !fault.empty()) return "contact: " + fault;
    const auto key = [](const radar::Result& r) { return std::pair(r.lo, r.object); };
    // Those of a step without a distance are all at 0, in the order of the fractions.
    const bool isOrdered = i == 0 || key(hits[i - 1]) < key(hit) || (end_ == 0 && isStep(scene_, query_));
    if (!isOrdered) return "contacts in disorder";
    if (hit.status == Status::undecided) continue;
    ++certain;
    last = std::max(last, spanOf(hit.object).early);
  }
  if (certain > query_.hits) return "too many contacts";
  for (const Course& course : courses_) {
    if (isListed[course.object]) continue;
    const Span span = spanOf(course.object);
    if (span.late > end_) continue;
    if (certain < query_.hits || span.late + span.tolerance < last) return "a contact that is not listed";
  }
  return "";
}

std::string NearTruth::faultOf(const radar::Result& result, std::span<const radar::Result> hits,
                               std::span<const radar::ObjectId> overlapping) const {
  if (!std::ranges::equal(overlapping, overlapping_)) return "wrong list of overlapping objects";
  if (std::string fault = faultOfOne(result, radar::kNone, query_.anyHit); !fault.empty()) return fault;
  if (query_.hits == 1) return hits.empty() ? "" : "a list";
  return faultOfList(hits);
}

}  // namespace oracle
