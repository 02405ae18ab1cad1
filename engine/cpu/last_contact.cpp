#include "cpu/last_contact.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace radar::cpu {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity(), kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

LastContact::LastContact(const Query& query, double end, double tolerance)
    : PairVisitor(end), query_(query), end_(end), tolerance_(tolerance), lo_(-kInfinity), hi_(-kInfinity) {}

std::optional<LastContact::Last> LastContact::lastOf(const exact::PlacedPair& pair) const {
  const Translation& motion = *motion_;
  const auto touching = exact::contact(pair.a, pair.b, motion.direction);
  if (!touching) return std::nullopt;
  const auto toEnd = [&](const exact::Event& event) { return exact::EarliestContact::compareToEnd(event, motion); };
  if (exact::sign(touching->last) < 0 || toEnd(touching->first) > 0) return std::nullopt;
  if (motion.end == 0 || toEnd(touching->last) >= 0) {
    return Last{motion.end, motion.end, touching->between.features(), {kNan, kNan, kNan}, {kNan, kNan, kNan}};
  }
  const exact::Event& event = touching->last;
  const exact::Span& span = touching->atLast;
  const double s = exact::parameter(event);
  Result times;
  exact::EarliestContact::setTimes(times, event, s, motion);
  Last last{times.lo, times.hi, span.features(), exact::point(event, s), exact::normal(event), 0, event};
  if (exact::sign(event) == 0) last.lo = last.hi = 0;
  if (last.features.b == Feature::vertex) {
    last.point = pair.b[std::countr_zero(span.b)];
  } else if (last.features.a == Feature::vertex) {
    last.point = along(pair.a[std::countr_zero(span.a)], s, motion.direction);
  }
  if (motion.isStep) last.point = along(last.point, s, motion.drift);
  // The sensor leaves along the motion.
  last.normal = scaled(-1, last.normal);
  return last;
}

std::optional<LastContact::Last> LastContact::lastWithin(const exact::PlacedPair& pair) const {
  const Translation& motion = *motion_;
  const auto found = leaving(pair.a, pair.b, motion, query_.clearance, tolerance_);
  if (!found) return std::nullopt;
  Last last{found->lo, found->hi, found->atLo.features, found->atLo.point, found->atLo.normal, found->atLo.distance};
  if (motion.isStep) {
    const bool isAtEnd = found->lo == motion.wayUntil(motion.end) || motion.stands;
    const double rate = motion.speed > 0 ? 1 / motion.speed : 0;
    last.lo = isAtEnd && found->lo >= 0 ? motion.end : found->lo > 0 ? (1 - 8 * kUnit) * (found->lo * rate) : found->lo;
    last.hi = isAtEnd ? motion.end : std::min((1 + 8 * kUnit) * (found->hi * rate), motion.end);
  }
  // No digits tell how far a tiny clearance is; but what touches is within it.
  if (found->lo < 0) {
    auto touching = lastOf(pair);
    if (!touching) return last;
    touching->hi = std::max(touching->hi, last.hi);
    touching->event.reset();
    return touching;
  }
  if (motion.isStep) last.point = along(last.point, last.hi, motion.drift);
  return last;
}

bool LastContact::isLater(const Last& last, const exact::PairName& name) const {
  if (!last_) return true;
  if (last.event && last_->event) {
    const int order = exact::compare(*last.event, *last_->event);
    return order > 0 || (order == 0 && name < name_);
  }
  return last.lo > last_->lo || (last.lo == last_->lo && name < name_);
}

void LastContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis) {
  if (isBefore(name)) return;
  const auto last = query_.clearance > 0 ? lastWithin(pair) : lastOf(pair);
  if (!last) return;
  lo_ = std::max(lo_, last->lo);
  hi_ = std::max(hi_, last->hi);
  if (!isLater(*last, name)) return;
  last_ = last;
  name_ = name;
  if (last->lo < 0) return;
  if (query_.clearance > 0 && !std::isnan(last->normal[0])) across_ = last->normal;
  atStart_ = last->lo == motion_->end;
  first_ = name;
  // What ends a little earlier may have a bracket that reaches beyond this one's.
  latest_ = std::min(latest_, (1 + 8 * kUnit) * (end_ - lo_) + 8 * kUnit * end_ + (motion_->isStep ? 0 : tolerance_));
}

Result LastContact::answer() const {
  if (!last_) return Result(Status::clear);
  const bool isCertain = lo_ >= 0;
  Result result(isCertain ? Status::hit : Status::undecided);
  result.lo = std::max(lo_, 0.0);
  if (!isCertain) {
    result.t = result.fraction = kInfinity;
    result.hi = hi_;
    result.object = name_.object;
    return result;
  }
  const double end = motion_->end;
  result.detected = Detected::yes;
  result.t = result.hi = hi_;
  result.fraction = end > 0 ? result.t / end : 0;
  result.object = name_.object;
  result.triB = name_.triB;
  result.triA = name_.triA;
  result.featureB = last_->features.b;
  result.featureA = last_->features.a;
  result.point = exact::withoutZeroSigns(last_->point);
  result.normal = exact::withoutZeroSigns(last_->normal);
  result.gap = last_->gap;
  return result;
}

}  // namespace radar::cpu
