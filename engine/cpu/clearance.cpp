#include "cpu/clearance.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace radar::cpu {

namespace {

// Of the sensor's size, if the query gives no tolerance.
constexpr double kTolerance = 1e-6;

}  // namespace

ClearanceContact::ClearanceContact(const Query& query, const Motion& motion, double size)
    : PairVisitor(motion.distance),
      query_(query),
      motion_(motion),
      tolerance_(query.tolerance.value_or(kTolerance * size)) {}

// Certain approaches come before open ones.
bool ClearanceContact::Near::precedes(const Near& other) const {
  if (approach.hi != other.approach.hi) return approach.hi < other.approach.hi;
  if (std::isinf(approach.hi) && approach.lo != other.approach.lo) return approach.lo < other.approach.lo;
  return name < other.name;
}

void ClearanceContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis) {
  if (isBefore(name)) return;
  if (query_.ignoreLeaving && !exact::blocks(pair.a, pair.b, motion_.direction, rule_.slack, rule_.mirrored)) return;
  const auto found = approach(pair.a, pair.b, motion_.unit, query_.clearance, motion_.distance, tolerance_);
  if (!found) return;
  Near near{name, *found, found->lo};
  if (best_.empty()) {
    best_.push_back(near);
  } else {
    near.lo = best_[0].lo = std::min(near.lo, best_[0].lo);
    if (!near.precedes(best_[0])) return;
    best_[0] = near;
  }
  decided_ = query_.anyHit && !std::isinf(near.approach.hi);
  atStart_ = near.approach.hi == 0;
  first_ = name;
  latest_ = std::min(latest_, near.approach.hi);
}

void ClearanceContact::endObject() {
  if (query_.hits == 1 || best_.empty()) return;
  const auto isBefore = [](const Near& p, const Near& q) { return p.precedes(q); };
  nearest_.insert(std::upper_bound(nearest_.begin(), nearest_.end(), best_[0], isBefore), best_[0]);
  if (nearest_.size() > query_.hits) nearest_.pop_back();
  latest_ = motion_.distance;
  if (nearest_.size() == query_.hits) latest_ = std::min(latest_, nearest_.back().approach.hi);
  atStart_ = false;
  best_.clear();
}

Result ClearanceContact::answer(const Near& near) const {
  Result result;
  const double hi = near.approach.hi;
  result.lo = near.lo;
  if (std::isinf(hi)) {
    result.status = Status::undecided;
    return result;
  }
  result.detected = Detected::yes;
  if (query_.anyHit) {
    result.status = Status::hit;
    result.lo = 0;
    result.hi = motion_.distance;
    return result;
  }
  result.status = hi == 0 ? Status::overlap : Status::hit;
  result.hi = hi;
  result.t = near.approach.lo;
  result.fraction = motion_.distance > 0 ? result.t / motion_.distance : 0;
  result.object = near.name.object;
  result.triB = near.name.triB;
  result.triA = near.name.triA;
  result.point = exact::withoutZeroSigns(near.approach.point);
  result.normal = exact::withoutZeroSigns(near.approach.normal);
  return result;
}

Result ClearanceContact::first() const {
  const std::vector<Near>& found = nearest_.empty() ? best_ : nearest_;
  if (found.empty()) {
    Result clear;
    clear.status = Status::clear;
    return clear;
  }
  Near first = found[0];
  for (const Near& near : found) first.lo = std::min(first.lo, near.lo);
  return answer(first);
}

std::vector<Result> ClearanceContact::nearest() const {
  std::vector<Result> results;
  results.reserve(nearest_.size());
  for (const Near& near : nearest_) results.push_back(answer(near));
  const auto place = [](const Result& result) {
    return std::pair(std::isnan(result.t) ? result.lo : result.t, result.object);
  };
  std::sort(results.begin(), results.end(), [&](const Result& p, const Result& q) { return place(p) < place(q); });
  return results;
}

}  // namespace radar::cpu
