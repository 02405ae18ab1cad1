#include "brute_force.h"

#include "blocking_oracle.h"
#include "exact/motion.h"

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

bool isMirrored(const Transform& pose) {
  const int scale = leastExponent(pose.m.data(), pose.m.size());
  const auto row = [&](size_t i) { return scaled(Corner{pose.m[4 * i], pose.m[4 * i + 1], pose.m[4 * i + 2]}, scale); };
  return dot(row(0), cross(row(1), row(2))) < 0;
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

bool isStep(const radar::Scene& scene, const radar::Query& query) {
  if (query.motion) return true;
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (scene.hasObject(id) && scene.object(id).motion != Corner{}) return true;
  }
  return false;
}

/// The sensor and one object on a common scale.
class Meeting {
 public:
  Meeting(const radar::Scene& scene, const radar::Query& query, radar::ObjectId id, bool isStep)
      : query_(query), id_(id), isStep_(isStep) {
    const radar::Object& object = scene.object(id);
    const radar::MeshView sensor = scene.mesh(query.mesh), mesh = scene.mesh(object.mesh);
    const double slack = query.slack.value_or(
        0x1p-48 * std::max(magnitude(sensor, query.worldFromMesh), magnitude(mesh, object.worldFromMesh)));
    const std::vector<Corners> a = placed(sensor, query.worldFromMesh), b = placed(mesh, object.worldFromMesh);
    std::vector<double> all{slack};
    for (const std::vector<Corners>* triangles : {&a, &b}) {
      for (const Corners& t : *triangles) {
        for (const Corner& c : t) all.insert(all.end(), c.begin(), c.end());
      }
    }
    scale_ = leastExponent(all.data(), all.size());
    slack_ = scaled(slack, scale_);
    Corner direction = query.direction;
    if (isStep) {
      const Corner displacement = radar::displacementOf(query);
      for (size_t k = 0; k < 3; ++k) direction[k] = displacement[k] - object.motion[k];
    }
    dirScale_ = leastExponent(direction.data(), 3);
    direction_ = scaled(direction, dirScale_);
    stands_ = isZero(direction_);
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

 private:
  /// When contact of two triangles begins, if it counts, is before `limit` and within D.
  std::optional<Fraction> startOf(const Boxed& a, const Boxed& b, const Fraction* limit) const {
    const auto isPressed = [&] { return query_.ignoreLeaving && arePressed(a.faced, b.faced, direction_, slack_); };
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
    if (query_.ignoreLeaving && !blocks(a.faced, b.faced, direction_, slack_)) return std::nullopt;
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

Truth truthOf(const radar::Scene& scene, const radar::Query& query) {
  Truth truth;
  const bool step = isStep(scene, query);
  for (radar::ObjectId id = 0; id < scene.objectLimit(); ++id) {
    if (!scene.hasObject(id) || (scene.object(id).mask & query.mask) == 0) continue;
    if (std::find(query.exclude.begin(), query.exclude.end(), id) != query.exclude.end()) continue;
    const Meeting meeting(scene, query, id, step);
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
