#include "brute_force.h"

#include <algorithm>

#include "blocking_oracle.h"
#include "exact/translation.h"
#include "radar/displacement.h"

namespace oracle {

namespace {

using radar::Transform;

/// The greatest sum of absolute values that a placed coordinate is summed from.
double magnitude(const radar::MeshView& mesh, const Transform& pose) {
  std::array<double, 3> most{};
  for (const uint32_t vertex : mesh.indices) {
    for (size_t k = 0; k < 3; ++k)
      most[k] = std::max(most[k], std::abs(double{mesh.positions[3 * size_t{vertex} + k]}));
  }
  double greatest = 0;
  for (size_t i = 0; i < 3; ++i) {
    double sum = std::abs(pose.m[4 * i + 3]);
    for (size_t k = 0; k < 3; ++k) sum += std::abs(pose.m[4 * i + k]) * most[k];
    greatest = std::max(greatest, sum);
  }
  return greatest;
}

std::vector<Corners> placed(const radar::MeshView& mesh, const Transform& pose) {
  std::vector<Corners> triangles;
  for (uint32_t i = 0; i < mesh.triangleCount(); ++i) triangles.push_back(corners(mesh, pose, i));
  return triangles;
}

/// A triangle and its extent along each axis.
struct Boxed {
  Faced faced;
  IntVec low, high;
};

std::vector<Boxed> boxed(const std::vector<Corners>& triangles, bool isMirrored, int scale) {
  std::vector<Boxed> out;
  for (const Corners& corners : triangles) {
    const IntTriangle t = scaled(corners, scale);
    Boxed one{faced(t, isMirrored), t[0], t[0]};
    for (size_t k = 0; k < 3; ++k) {
      for (const IntVec& corner : t) {
        if (corner[k] < one.low[k]) one.low[k] = corner[k];
        if (corner[k] > one.high[k]) one.high[k] = corner[k];
      }
    }
    out.push_back(std::move(one));
  }
  return out;
}

IntVec times(const Integer& factor, const IntVec& v) {
  return {Integer(factor * v[0]), Integer(factor * v[1]), Integer(factor * v[2])};
}

IntVec plus(const IntVec& p, const IntVec& q) {
  return {Integer(p[0] + q[0]), Integer(p[1] + q[1]), Integer(p[2] + q[2])};
}

/// The point at / w, w > 0.
struct Place {
  IntVec at;
  Integer w = 1;
};

/// From the point to a corner, times w.
IntVec from(const Place& point, const IntVec& corner) {
  return minus(times(point.w, corner), point.at);
}

bool contains(const IntTriangle& t, const Place& point) {
  const std::array<IntVec, 3> to{from(point, t[0]), from(point, t[1]), from(point, t[2])};
  const std::array<IntVec, 3> sides{cross(to[0], to[1]), cross(to[1], to[2]), cross(to[2], to[0])};
  if (std::all_of(sides.begin(), sides.end(), isZero)) {  // on one line with the triangle
    return dot(to[0], to[1]) <= 0 || dot(to[1], to[2]) <= 0 || dot(to[2], to[0]) <= 0;
  }
  return dot(to[0], sides[1]) == 0 && dot(sides[0], sides[1]) >= 0 && dot(sides[1], sides[2]) >= 0 &&
         dot(sides[2], sides[0]) >= 0;
}

/// The corners of what two triangles have in common.
std::vector<Place> commonCorners(const IntTriangle& a, const IntTriangle& b) {
  std::vector<Place> out;
  for (size_t i = 0; i < 3; ++i) {
    if (contains(b, {a[i]})) out.push_back({a[i]});
    if (contains(a, {b[i]})) out.push_back({b[i]});
    for (size_t k = 0; k < 3; ++k) {
      const IntVec u = minus(a[(i + 1) % 3], a[i]), v = minus(b[(k + 1) % 3], b[k]), gap = minus(b[k], a[i]);
      const IntVec n = cross(u, v);
      if (isZero(n) || dot(n, gap) != 0) continue;
      const Integer square = dot(n, n), onA = dot(cross(gap, v), n), onB = dot(cross(gap, u), n);
      if (onA < 0 || onA > square || onB < 0 || onB > square) continue;
      out.push_back({plus(times(square, a[i]), times(onA, u)), square});
    }
  }
  return out;
}

/// A normal as given, off by its rounding.
struct RoundedNormal {
  IntVec n;  ///< times 2^bits
  int bits;

  explicit RoundedNormal(const Corner& given) : bits(-leastExponent(given.data(), 3)) { n = scaled(given, -bits); }

  /// Whether n . c >= 0 for all c, to rounding.
  bool keeps(const std::vector<IntVec>& differences) const {
    return std::all_of(differences.begin(), differences.end(), [&](const IntVec& c) {
      const Integer size = abs(c[0]) + abs(c[1]) + abs(c[2]);
      return (dot(n, c) << 50) + (size << bits) >= 0;
    });
  }
  bool isUnit() const {
    const Integer one = Integer(1) << 2 * bits;
    return (abs(dot(n, n) - one) << 49) <= one;
  }
};

/// The normals of the faces of the difference of two triangles.
std::vector<IntVec> ownNormals(const IntTriangle& a, const IntTriangle& b) {
  std::vector<IntVec> out;
  const auto edge = [](const IntTriangle& t, size_t i) { return minus(t[(i + 1) % 3], t[i]); };
  out.push_back(cross(edge(a, 0), edge(a, 1)));
  out.push_back(cross(edge(b, 0), edge(b, 1)));
  for (size_t i = 0; i < 9; ++i) out.push_back(cross(edge(a, i / 3), edge(b, i % 3)));
  return out;
}

/// The sensor and one object on a common scale.
class Meeting {
 public:
  Meeting(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id)
      : query_(query), id_(id), isStep_(isStep(scene, query)) {
    const radar::Object& object = scene.object(id);
    const radar::MeshView sensor = scene.mesh(query.mesh), mesh = scene.mesh(object.mesh);
    const double slack = slackOf(scene, query, id);
    const std::vector<Corners> a = placed(sensor, query.worldFromMesh), b = placed(mesh, object.worldFromMesh);
    std::vector<double> all{slack};
    for (const std::vector<Corners>* triangles : {&a, &b}) {
      for (const Corners& t : *triangles) {
        for (const Corner& c : t) all.insert(all.end(), c.begin(), c.end());
      }
    }
    scale_ = leastExponent(all.data(), all.size());
    slack_ = scaled(slack, scale_);
    const Corner direction = directionPast(scene, query, id);
    dirScale_ = leastExponent(direction.data(), 3);
    direction_ = scaled(direction, dirScale_);
    stands_ = isZero(direction_);
    const radar::Translation sweep = isStep_ ? radar::Translation(direction, {}) : radar::Translation(query);
    whole_ = courseOf(isStep_ ? direction : sweep.direction, sweep.end, sweep.length, scale_);
    course_ = stands_ ? IntVec{1, 2, 3} : direction_;
    a_ = boxed(a, isMirrored(query.worldFromMesh), scale_);
    b_ = boxed(b, isMirrored(object.worldFromMesh), scale_);
  }

  bool surfacesCross() const {
    for (const Boxed& b : b_) {
      for (const Boxed& a : a_) {
        const auto apart = [&](size_t k) { return a.high[k] < b.low[k] || b.high[k] < a.low[k]; };
        if (!apart(0) && !apart(1) && !apart(2) && cross(a.faced, b.faced, slack_)) return true;
      }
    }
    return false;
  }

  /// Within D.
  std::optional<Contact> first() const {
    std::optional<Contact> best;
    for (uint32_t triB = 0; triB < b_.size(); ++triB) {
      for (uint32_t triA = 0; triA < a_.size(); ++triA) {
        // The first of equals stays.
        if (best && best->s.sign() == 0) return best;
        if (auto s = startOf(a_[triA], b_[triB], best ? &best->s : nullptr)) best = {*s, id_, triB, triA, isStep_};
      }
    }
    if (best) unscale(best->s, scale_, dirScale_);
    return best;
  }

  /// oracle::faultOfNormal.
  std::string faultOfNormal(const radar::Result& hit) const {
    const std::optional<Interval> interval = contact(a_[hit.triA].faced.corners, b_[hit.triB].faced.corners, course_);
    if (!interval && query_.ignoreLeaving) return "";  // pressed together, but for a rounding
    if (!interval) return "its triangles do not meet";
    const bool exists = !std::isnan(hit.normal[0]);
    if (hit.status == radar::Status::overlap && interval->first.sign() != 0)
      return exists ? "a start has a normal" : "";
    if (!exists) return "null";
    const RoundedNormal normal(hit.normal);
    if (!normal.isUnit()) return "not a unit vector";
    const IntVec back = times(-1, course_);
    if (!normal.keeps({back})) return "along the motion";
    const Moment moment(*this, interval->first);
    const IntTriangle &a = moment.a[hit.triA], &b = moment.b[hit.triB];
    if (!normal.keeps(differencesOf(a, b))) return "does not keep the triangles apart";
    if (hit.status == radar::Status::overlap) return "";
    const std::vector<IntVec> around = moment.around(nearest(commonCorners(a, b), hit.point, interval->first.den));
    if (detail::hasNormal(around, {}, 0, &back) && !normal.keeps(around)) return "does not keep the surfaces apart";
    if (moment.someNormalKeepsAllApart(back) && !normal.keeps(moment.all)) return "does not keep all contacts apart";
    return "";
  }

 private:
  static std::vector<IntVec> differencesOf(const IntTriangle& a, const IntTriangle& b) {
    std::vector<IntVec> out;
    for (const IntVec& p : a) {
      for (const IntVec& q : b) out.push_back(minus(p, q));
    }
    return out;
  }

  /// Both shapes when contact begins, on a common scale, and what touches then.
  struct Moment {
    std::vector<IntTriangle> a, b;
    std::vector<std::pair<size_t, size_t>> touching;
    std::vector<IntVec> all;  ///< a - b for all corners of what touches

    Moment(const Meeting& m, const Fraction& s) {
      for (const Boxed& t : m.a_) a.push_back(t.faced.corners);
      for (const Boxed& t : m.b_) b.push_back(t.faced.corners);
      for (IntTriangle& t : a) {
        for (IntVec& p : t) p = plus(times(s.den, p), times(s.num, m.course_));
      }
      for (IntTriangle& t : b) {
        for (IntVec& p : t) p = times(s.den, p);
      }
      for (size_t i = 0; i < a.size(); ++i) {
        for (size_t k = 0; k < b.size(); ++k) {
          const auto met = m.boxesMeet(m.a_[i], m.b_[k], nullptr)
                               ? contact(m.a_[i].faced.corners, m.b_[k].faced.corners, m.course_)
                               : std::nullopt;
          if (!met || compare(met->first, s) > 0 || compare(met->last, s) < 0) continue;
          if (m.query_.ignoreLeaving && !blocks(m.a_[i].faced, m.b_[k].faced, m.whole_, m.slack_)) continue;
          touching.emplace_back(i, k);
          const std::vector<IntVec> own = differencesOf(a[i], b[k]);
          all.insert(all.end(), own.begin(), own.end());
        }
      }
    }

    /// a - point and point - b, for all corners of what touches at a point.
    std::vector<IntVec> around(const Place& point) const {
      std::vector<IntVec> out;
      for (const auto& [i, k] : touching) {
        if (!contains(a[i], point) || !contains(b[k], point)) continue;
        for (const IntVec& p : a[i]) out.push_back(from(point, p));
        for (const IntVec& p : b[k]) out.push_back(times(-1, from(point, p)));
      }
      return out;
    }

    bool someNormalKeepsAllApart(const IntVec& back) const {
      for (const auto& [i, k] : touching) {
        for (IntVec n : ownNormals(a[i], b[k])) {
          const int side = dot(n, back).sign();
          if (side == 0) continue;
          const auto keeps = [&](const IntVec& c) { return side * dot(n, c) >= 0; };
          if (std::all_of(all.begin(), all.end(), keeps)) return true;
        }
      }
      return false;
    }
  };

  /// The place nearest to a point that was rounded.
  Place nearest(const std::vector<Place>& places, const Corner& point, const Integer& den) const {
    Place best = places.at(0);
    double least = INFINITY;
    for (const Place& place : places) {
      double far = 0;
      for (size_t k = 0; k < 3; ++k) {
        const double at = std::ldexp(Rational(place.at[k], place.w * den).convert_to<double>(), scale_);
        far = std::max(far, std::abs(at - point[k]));
      }
      if (far >= least) continue;
      least = far;
      best = place;
    }
    return best;
  }

  /// When contact of two triangles begins, if it counts, is before `limit` and within D.
  std::optional<Fraction> startOf(const Boxed& a, const Boxed& b, const Fraction* limit) const {
    const auto isPressed = [&] { return query_.ignoreLeaving && arePressed(a.faced, b.faced, whole_, slack_); };
    if (!boxesMeet(a, b, limit) && !isPressed()) return std::nullopt;
    const std::optional<Interval> interval = contact(a.faced.corners, b.faced.corners, course_);
    if (!interval || interval->last.sign() < 0) {
      // Rounding may have let triangles pass each other that are pressed together.
      if (!isPressed()) return std::nullopt;
      return Fraction{};
    }
    const Fraction s = interval->first.sign() < 0 ? Fraction{} : interval->first;
    if (limit != nullptr && compare(s, *limit) >= 0) return std::nullopt;
    if (isBeyondD(s)) return std::nullopt;
    if (query_.ignoreLeaving && !blocks(a.faced, b.faced, whole_, slack_)) return std::nullopt;
    return s;
  }

  /// Whether the triangles' boxes meet at the start or later, before `limit` and within D.
  bool boxesMeet(const Boxed& a, const Boxed& b, const Fraction* limit) const {
    std::optional<Interval> interval;
    for (size_t k = 0; k < 3; ++k) {
      if (!allow(interval, b.low[k] - a.high[k], b.high[k] - a.low[k], course_[k])) return false;
    }
    if (interval->last.sign() < 0) return false;
    if (limit != nullptr && compare(interval->first, *limit) >= 0) return false;
    return interval->first.sign() < 0 || !isBeyondD(interval->first);
  }

  bool isBeyondD(Fraction s) const {
    if (stands_) return s.sign() > 0;
    unscale(s, scale_, dirScale_);
    return isStep_ ? compare(s, {1, 1}) > 0 : compareToDistance(s, query_.direction, query_.distance) > 0;
  }

  const radar::Query& query_;
  radar::ObjectId id_;
  int scale_ = 0, dirScale_ = 0;
  Integer slack_;
  IntVec direction_;
  Course whole_;
  bool isStep_, stands_ = false;
  IntVec course_;  ///< the direction, or any if the sensor stands
  std::vector<Boxed> a_, b_;
};

std::string describe(const Contact* contact) {
  if (contact == nullptr) return "clear";
  const Rational s(contact->s.num, contact->s.den);
  return "s " + std::to_string(s.convert_to<double>()) + ", object " + std::to_string(contact->object) +
         ", triangles " + std::to_string(contact->triA) + " and " + std::to_string(contact->triB);
}

}  // namespace

bool takesPart(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id) {
  return scene.hasObject(id) && (scene.object(id).mask & query.mask) != 0 &&
         std::find(query.exclude.begin(), query.exclude.end(), id) == query.exclude.end();
}

bool isMirrored(const Transform& pose) {
  const int scale = leastExponent(pose.m.data(), pose.m.size());
  const auto row = [&](size_t i) { return scaled(Corner{pose.m[4 * i], pose.m[4 * i + 1], pose.m[4 * i + 2]}, scale); };
  return dot(row(0), cross(row(1), row(2))) < 0;
}

double slackOf(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id) {
  const radar::Object& object = scene.object(id);
  return query.slack.value_or(0x1p-48 * std::max(magnitude(scene.mesh(query.mesh), query.worldFromMesh),
                                                 magnitude(scene.mesh(object.mesh), object.worldFromMesh)));
}

bool isStep(const radar::Scene& scene, const radar::Query& query) {
  if (query.motion) return true;
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id) && scene.object(id).motion != Corner{}) return true;
  }
  return false;
}

Corner directionPast(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id) {
  if (!isStep(scene, query)) return query.direction;
  Corner direction = radar::displacementOf(query);
  for (size_t k = 0; k < 3; ++k) direction[k] -= scene.object(id).motion[k];
  return direction;
}

bool surfacesCross(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id) {
  return Meeting(scene, query, id).surfacesCross();
}

Truth truthOf(const radar::Scene& scene, const radar::Query& query) {
  Truth truth;
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!takesPart(scene, query, id)) continue;
    const Meeting meeting(scene, query, id);
    if (query.skipOverlapping && meeting.surfacesCross()) {
      truth.overlapping.push_back(id);
    } else if (std::optional<Contact> first = meeting.first()) {
      truth.contacts.push_back(std::move(*first));
    }
  }
  std::stable_sort(truth.contacts.begin(), truth.contacts.end(),
                   [](const Contact& p, const Contact& q) { return compare(p.s, q.s) < 0; });
  return truth;
}

int compareToTime(const Contact& contact, const radar::Query& query, double limit) {
  const Fraction& s = contact.s;
  if (!contact.isOfStep) return compareToDistance(s, query.direction, limit);
  const std::array<double, 2> both{query.motion ? 1 : query.distance, limit};
  const int scale = leastExponent(both.data(), both.size());
  return Integer(s.num * scaled(both[0], scale)).compare(Integer(s.den * scaled(both[1], scale)));
}

std::string faultOf(const Contact* contact, const radar::Query& query, const radar::Result& result) {
  using radar::Status;
  const auto but = [&](const char* what) { return std::string(what) + "; the truth is " + describe(contact); };
  const Status status = contact == nullptr ? Status::clear : contact->s.sign() == 0 ? Status::overlap : Status::hit;
  if (result.status != status) return but("wrong status");
  if (contact == nullptr) return "";
  if (result.object != contact->object) return but("wrong object");
  if (result.triB != contact->triB || result.triA != contact->triA) return but("wrong triangles");
  if (!(result.lo <= result.t && result.t <= result.hi && result.hi <= (query.motion ? 1 : query.distance)))
    return but("bounds in disorder");
  if (!(result.hi - result.lo <= (contact->isOfStep ? 1e-14 : 5e-15) * result.hi + 1e-300)) return but("wide bounds");
  const bool isBetween =
      compareToTime(*contact, query, result.lo) >= 0 && compareToTime(*contact, query, result.hi) <= 0;
  return isBetween ? "" : but("t* is not within the bounds");
}

std::string faultOfNormal(const radar::Scene& scene, const radar::Query& query, const radar::Result& hit) {
  return Meeting(scene, query, hit.object).faultOfNormal(hit);
}

std::string faultOf(const Truth& truth, const radar::Query& query, const radar::Result& result,
                    std::span<const radar::Result> hits, std::span<const radar::ObjectId> overlapping) {
  if (!std::equal(overlapping.begin(), overlapping.end(), truth.overlapping.begin(), truth.overlapping.end())) {
    return "wrong list of overlapping objects";
  }
  std::string fault = faultOf(truth.contacts.empty() ? nullptr : &truth.contacts[0], query, result);
  if (!fault.empty()) return fault;
  const size_t expected = query.hits == 1 ? 0 : std::min<size_t>(query.hits, truth.contacts.size());
  if (hits.size() != expected) return "wrong number of contacts: " + std::to_string(hits.size());
  for (size_t i = 0; i < expected; ++i) {
    const std::string wrong = faultOf(&truth.contacts[i], query, hits[i]);
    if (!wrong.empty()) return "contact " + std::to_string(i) + ": " + wrong;
  }
  return "";
}

}  // namespace oracle
