#include "exact/earliest_contact.h"

#include <algorithm>
#include <limits>

#include "exact/common_point.h"
#include "exact/determinant.h"
#include "exact/event.h"

namespace radar::exact {

std::optional<EarliestContact::Beginning> EarliestContact::beginningOf(const PlacedPair& pair) const {
  const auto interval = contact(pair.a, pair.b, motion_->direction);
  if (!interval) return std::nullopt;
  const int last = sign(interval->last);
  if (last < 0) return std::nullopt;
  const int first = sign(interval->first);
  const Features features = first >= 0 ? interval->atFirst : last == 0 ? interval->atLast : interval->between;
  return Beginning{interval->first, first <= 0, features};
}

bool EarliestContact::considerPressed(const PairName& name, const PlacedPair& pair) {
  // Any event before the start will do.
  const Vector& d = motion_->direction;
  Beginning beginning = beginningOf(pair).value_or(Beginning{vertexVertex(d, d, kOrigin), true, {}});
  beginning.features = {Feature::face, Feature::face};
  return precedes(name, beginning) && keep(name, pair, beginning);
}

// -1, 0 or 1: the event comes before, at or after the end of the motion.
int EarliestContact::compareToEnd(const Event& event, const Motion& motion) {
  if (event.s + event.error < motion.parameter) return -1;
  if (motion.isStep) return compareToParameter(event, motion.stands ? 0 : 1);
  return compareToDistance(event, motion.distance);
}

// -1, 0 or 1: a contact that begins with `event` comes before, with or after the other.
int EarliestContact::compareTimes(bool overlap, const Event& event, const EarliestContact& other) {
  return overlap || other.overlap_ ? int(other.overlap_) - int(overlap) : compare(event, other.event_);
}

bool EarliestContact::precedes(const EarliestContact& other) const {
  const int order = compareTimes(overlap_, event_, other);
  return order < 0 || (order == 0 && name_ < other.name_);
}

bool EarliestContact::precedes(const PairName& name, const Beginning& beginning) const {
  if (!beginning.overlap && compareToEnd(beginning.first, *motion_) > 0) return false;
  if (!found_) return true;
  const int order = compareTimes(beginning.overlap, beginning.first, *this);
  return order < 0 || (order == 0 && !(name_ < name));
}

bool EarliestContact::keep(const PairName& name, const PlacedPair& pair, const Beginning& beginning) {
  found_ = true;
  overlap_ = beginning.overlap;
  name_ = name;
  pair_ = pair;
  event_ = beginning.first;
  kept_ = *motion_;
  features_ = beginning.features;
  return true;
}

Result EarliestContact::answer(bool anyHit) const {
  if (!found_) return Result(Status::clear);
  Result result;
  result.detected = Detected::yes;
  if (anyHit) {
    result.status = Status::hit;
    result.lo = 0;
    result.hi = kept_.distance;
  } else {
    describe(result);
  }
  return result;
}

void EarliestContact::describe(Result& result) const {
  result.status = overlap_ ? Status::overlap : Status::hit;
  result.object = name_.object;
  result.triB = name_.triB;
  result.triA = name_.triA;
  result.featureB = features_.b;
  result.featureA = features_.a;
  const double s = overlap_ ? 0 : parameter(event_);
  if (!overlap_ || sign(event_) == 0) {
    result.point = point(event_, s);
    if (kept_.isStep) result.point = withoutZeroSigns(along(result.point, s, kept_.drift));
    result.normal = normal(event_);
  } else {
    result.point = commonPoint(pair_.a, pair_.b);
  }
  if (overlap_) {
    result.t = result.lo = result.hi = result.fraction = 0;
  } else {
    setBracket(result, s * kept_.length);
  }
}

void EarliestContact::setBracket(Result& result, double t) const {
  const double distance = kept_.distance;
  const bool atEnd = compareToEnd(event_, kept_) == 0;
  result.t = atEnd ? distance : std::min(t, distance);
  // Three roundings of half an ulp each, of the parameter, the length and the product, and one more here; the floor is
  // what the parameter may lose if it is subnormal.
  const double slack = 8 * kUnit * t + (kept_.length + 2) * std::numeric_limits<double>::denorm_min();
  result.lo = atEnd ? distance : std::min(std::max(t - slack, 0.0), result.t);
  result.hi = atEnd ? distance : std::min(t + slack, distance);
  result.fraction = result.t / distance;
}

}  // namespace radar::exact
