#include "cpu/first_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cpu/certificate.h"
#include "cpu/swept_overlap.h"
#include "exact/common_point.h"

namespace radar::cpu {

namespace {

/// -1, 0 or 1: the event comes before, at or after D.
int compareToEnd(const exact::Event& event, const Motion& motion) {
  return event.s + event.error < motion.parameter ? -1 : exact::compareToDistance(event, motion.distance);
}

}  // namespace

FirstContact::FirstContact(const Motion& motion, bool anyHit, const Vector& sensor, double size)
    : motion_(motion), view_(sensor, size, motion.unit), anyHit_(anyHit), latest_(motion.distance) {}

void FirstContact::consider(const PairName& name, const exact::Triangle& a, const exact::Triangle& b, Axis axis) {
  if (isBefore(name)) return;
  const Vector& d = motion_.direction;
  if (const Feature feature = certainlyFirst(a, b, d, axis); feature != kNoFeature) {
    const exact::Event event = eventOf(feature, a, b, d);
    if (event.s > event.error) return keep(name, a, b, event, false);
  }
  if (!mayMeet(ViewedTriangle(a, view_), ViewedTriangle(b, view_), view_.scale * latest_)) return;
  const auto interval = exact::contact(a, b, d);
  if (!interval || exact::sign(interval->last) < 0) return;
  keep(name, a, b, interval->first, exact::sign(interval->first) <= 0);
}

void FirstContact::keep(const PairName& name, const exact::Triangle& a, const exact::Triangle& b,
                        const exact::Event& first, bool overlap) {
  if (!overlap && compareToEnd(first, motion_) > 0) return;
  if (found_) {
    const int order = overlap || overlap_ ? int(overlap_) - int(overlap) : exact::compare(first, event_);
    if (order > 0 || (order == 0 && name_ < name)) return;
  }
  // A distance a little beyond t*: what the parameter, the length and the product may have lost.
  double latest = 0;
  if (!overlap) {
    const bool rough = first.error > 1e-12 * first.s;
    const double s = rough ? exact::parameter(first) : first.s + first.error;
    latest = s * motion_.length * (1 + 8 * kUnit);
  }
  found_ = true;
  overlap_ = overlap;
  name_ = name;
  event_ = first;
  a_ = a;
  b_ = b;
  latest_ = std::min(motion_.distance, latest);
}

Result FirstContact::result() const {
  Result result;
  result.status = Status::clear;
  if (!found_) return result;
  result.detected = Detected::yes;
  if (anyHit_) {
    result.status = Status::hit;
    result.lo = 0;
    result.hi = motion_.distance;
    return result;
  }
  result.status = overlap_ ? Status::overlap : Status::hit;
  result.object = name_.object;
  result.triB = name_.triB;
  result.triA = name_.triA;
  const double s = overlap_ ? 0 : exact::parameter(event_);
  if (!overlap_ || exact::sign(event_) == 0) {
    result.point = exact::point(event_, s);
    result.normal = exact::normal(event_);
  } else {
    result.point = exact::commonPoint(a_, b_);
  }
  if (overlap_) {
    result.t = result.lo = result.hi = result.fraction = 0;
  } else {
    setBracket(result, s * motion_.length);
  }
  return result;
}

void FirstContact::setBracket(Result& result, double t) const {
  const double distance = motion_.distance;
  const bool atEnd = compareToEnd(event_, motion_) == 0;
  result.t = atEnd ? distance : std::min(t, distance);
  // Three roundings of half an ulp each, of the parameter, the length and the product, and one more here; the floor is
  // what the parameter may lose where it is subnormal.
  const double slack = 8 * kUnit * t + (motion_.length + 2) * std::numeric_limits<double>::denorm_min();
  result.lo = atEnd ? distance : std::min(std::max(t - slack, 0.0), result.t);
  result.hi = std::min(t + slack, distance);
  result.fraction = result.t / distance;
}

}  // namespace radar::cpu
