#include "exact/earliest_contact.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "exact/common_point.h"
#include "exact/determinant.h"
#include "exact/event.h"

namespace radar::exact {

std::optional<EarliestContact::Beginning> EarliestContact::beginningOf(const PlacedPair& pair) const {
  const auto interval = contact(pair.a, pair.b, motion_->direction, Ahead::beginning);
  if (!interval) return std::nullopt;
  const int last = sign(interval->last);
  if (last < 0) return std::nullopt;
  const int first = sign(interval->first);
  const Span& span = first >= 0 ? interval->atFirst : last == 0 ? interval->atLast : interval->between;
  return Beginning{interval->first, first <= 0, span.features(), span, interval->isSharp};
}

bool EarliestContact::considerPressed(const PairName& name, const PlacedPair& pair) {
  // Any event before the start will do.
  const Vector& d = motion_->direction;
  Beginning beginning = beginningOf(pair).value_or(Beginning{vertexVertex(d, d, kOrigin), true, {}, {}, false});
  beginning.features = {Feature::face, Feature::face};
  return offer(name, pair, beginning, [] { return true; });
}

int EarliestContact::compareToEnd(const Event& event, const Translation& motion) {
  if (event.s + event.error < motion.parameter) return -1;
  if (motion.isStep) return compareToParameter(event, motion.stands ? 0 : 1);
  return compareToDistance(event, motion.end);
}

// -1, 0 or 1: a contact that begins with `event` comes before, with or after the other.
int EarliestContact::compareTimes(bool overlap, const Event& event, const EarliestContact& other) {
  return overlap || other.overlap_ ? int(other.overlap_) - int(overlap) : compare(event, other.event_);
}

bool EarliestContact::precedes(const EarliestContact& other) const {
  const int order = compareTimes(overlap_, event_, other);
  return order < 0 || (order == 0 && name_ < other.name_);
}

double EarliestContact::latest() const {
  if (overlap_) return 0;
  const bool rough = event_.error > 1e-12 * event_.s;
  const double s = rough ? parameter(event_) : event_.s + event_.error;
  return s * kept_.length * (1 + 8 * kUnit);
}

int EarliestContact::orderOf(const Beginning& beginning) const {
  if (!beginning.overlap && compareToEnd(beginning.first, *motion_) > 0) return 1;
  return found_ ? compareTimes(beginning.overlap, beginning.first, *this) : -1;
}

bool EarliestContact::keep(const PairName& name, const PlacedPair& pair, const Beginning& beginning, int order) {
  if (order < 0) {
    touching_.clear();
  } else if (!overlap_) {
    touching_.reserve(8);  // boxes touch in two pairs or more
    const bool isFirst = name < name_;
    touching_.push_back(isFirst ? TouchingPair{name_, pair_} : TouchingPair{name, pair});
    if (!isFirst) return false;
  }
  found_ = true;
  overlap_ = beginning.overlap;
  name_ = name;
  pair_ = pair;
  event_ = beginning.first;
  kept_ = *motion_;
  features_ = beginning.features;
  span_ = beginning.span;
  isSharp_ = beginning.isSharp;
  return true;
}

Result EarliestContact::answer(bool anyHit) const {
  if (!found_) return Result(Status::clear);
  Result result;
  result.detected = Detected::yes;
  if (anyHit) {
    result.status = Status::hit;
    result.lo = 0;
    result.t = result.hi = kept_.end;
    result.fraction = kept_.end > 0 ? 1 : 0;
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
  const bool begins = !overlap_ || sign(event_) == 0;
  result.point = pointAt(s, begins);
  if (begins) result.normal = normalOf();
  result.gap = 0;
  if (overlap_) {
    result.t = result.lo = result.hi = result.fraction = 0;
  } else {
    setTimes(result, event_, s, kept_);
  }
}

Vector EarliestContact::pointAt(double s, bool begins) const {
  // A corner that touches is the point, exactly.
  const bool isNamed = !isSharp_ || !begins;
  Vector at;
  if (isNamed && features_.b == Feature::vertex) {
    at = withoutZeroSigns(pair_.b[std::countr_zero(span_.b)]);
  } else if (isNamed && features_.a == Feature::vertex) {
    at = withoutZeroSigns(along(pair_.a[std::countr_zero(span_.a)], s, event_.direction));
  } else {
    at = begins ? point(event_, s) : commonPoint(pair_.a, pair_.b);
  }
  return kept_.isStep ? withoutZeroSigns(along(at, s, kept_.drift)) : at;
}

Vector EarliestContact::normalOf() const {
  if (isSharp_) return normal(event_);
  const TouchingPair own{name_, pair_};
  std::vector<const TouchingPair*> pairs{&own};
  for (const TouchingPair& pair : touching_) {
    if (pair.name.object == name_.object) pairs.push_back(&pair);
  }
  return contactNormal(event_, span_, pairs);
}

void EarliestContact::setTimes(Result& result, const Event& event, double s, const Translation& motion) {
  const double distance = motion.end, t = s * motion.length;
  const bool atEnd = compareToEnd(event, motion) == 0;
  result.t = atEnd ? distance : std::min(t, distance);
  // Three roundings of half an ulp each, of the parameter, the length and the product, and one more here; the floor is
  // what the parameter may lose if it is subnormal.
  const double slack = 8 * kUnit * t + (motion.length + 2) * std::numeric_limits<double>::denorm_min();
  result.lo = atEnd ? distance : std::min(std::max(t - slack, 0.0), result.t);
  result.hi = atEnd ? distance : std::min(t + slack, distance);
  result.fraction = result.t / distance;
}

}  // namespace radar::exact
