#include "cpu/bracketed_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar::cpu {

BracketedContact::BracketedContact(const Query& query, double end, double tolerance)
    : PairVisitor(end), query_(query), end_(end), tolerance_(tolerance), lo_(std::numeric_limits<double>::infinity()) {}

bool BracketedContact::Near::isCertain() const {
  return !std::isinf(approach.hi);
}

// Certain approaches come before open ones.
bool BracketedContact::Near::precedes(const Near& other) const {
  if (approach.hi != other.approach.hi) return approach.hi < other.approach.hi;
  if (!isCertain() && approach.lo != other.approach.lo) return approach.lo < other.approach.lo;
  return name < other.name;
}

void BracketedContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis) {
  if (isBefore(name)) return;
  const std::optional<Approach> found = bracketOf(name, pair);
  if (!found) return;
  Near near{name, *found, found->lo};
  const bool matters = !best_ || near.lo < best_->lo || near.precedes(*best_);
  if (!matters || !counts(pair)) return;
  lo_ = std::min(lo_, near.lo);
  if (best_) near.lo = best_->lo = std::min(near.lo, best_->lo);
  if (best_ && !near.precedes(*best_)) return;
  best_ = near;
  if (near.isCertain() && !std::isnan(near.approach.atLo.normal[0])) across_ = near.approach.atLo.normal;
  atStart_ = near.approach.hi == 0;
  // Of what meets at the start, the caller finds the pair to name, but for a turn that may leave.
  const bool isNamedHere = query_.turn && query_.ignoreLeaving;
  decided_ = near.isCertain() && (query_.anyHit || (atStart_ && query_.hits == 1 && !isNamedHere));
  first_ = {name.object, 0, 0};
  // A later pair may have a bracket that begins before this one's, which then widens that of the answer.
  latest_ = std::min(latest_, near.approach.hi + tolerance_);
}

void BracketedContact::endObject() {
  if (query_.hits == 1 || !best_) return;
  if (best_->isCertain()) {
    latest_ = std::min(end_, addNearest(nearest_, query_.hits, *best_));
    atStart_ = false;
  } else {
    open_.push_back(*best_);
  }
  best_.reset();
}

Result BracketedContact::answer(const Near& near) const {
  Result result(!near.isCertain() ? Status::undecided : near.approach.hi == 0 ? Status::overlap : Status::hit);
  result.lo = near.lo;
  result.object = near.name.object;
  if (!near.isCertain()) return result;
  result.detected = Detected::yes;
  result.t = near.lo;
  result.hi = near.approach.hi;
  result.fraction = end_ > 0 ? result.t / end_ : 0;
  result.triB = near.name.triB;
  result.triA = near.name.triA;
  setSeparation(result, near.approach.atLo);
  if (query_.clearance == 0) result.gap = 0;
  return result;
}

Result BracketedContact::first() const {
  if (nearest_.empty() && !best_ && open_.empty()) return Result(Status::clear);
  Near first = !nearest_.empty() ? nearest_[0] : best_ ? *best_ : open_[0];
  first.lo = lo_;
  if (first.isCertain() && !query_.anyHit) return answer(first);
  // No ids, as of any decision and of what is undecided.
  Result result(first.isCertain() ? Status::hit : Status::undecided);
  result.lo = first.isCertain() ? 0 : lo_;
  if (first.isCertain()) result.t = result.hi = end_;
  if (first.isCertain()) result.fraction = end_ > 0 ? 1 : 0;
  if (first.isCertain()) result.detected = Detected::yes;
  return result;
}

std::vector<Result> BracketedContact::nearest() const {
  std::vector<Result> results;
  const bool isFull = nearest_.size() == query_.hits;
  for (const Near& near : nearest_) results.push_back(answer(near));
  for (const Near& near : open_) {
    if (!isFull || near.lo <= nearest_.back().approach.hi) results.push_back(answer(near));
  }
  std::sort(results.begin(), results.end(),
            [](const Result& p, const Result& q) { return p.lo != q.lo ? p.lo < q.lo : p.object < q.object; });
  return results;
}

void setSeparation(Result& result, const Separation& separation) {
  result.featureB = separation.features.b;
  result.featureA = separation.features.a;
  result.point = exact::withoutZeroSigns(separation.point);
  result.normal = exact::withoutZeroSigns(separation.normal);
  result.gap = separation.distance;
}

}  // namespace radar::cpu
