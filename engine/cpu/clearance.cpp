#include "cpu/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "exact/event.h"

namespace radar::cpu {

namespace {

// Of the longest side of the sensor's box, or of the clearance.
constexpr double kTolerance = 1e-6;

void setSeparation(Result& result, const Separation& separation) {
  result.featureB = separation.features.b;
  result.featureA = separation.features.a;
  result.point = exact::withoutZeroSigns(separation.point);
  result.normal = exact::withoutZeroSigns(separation.normal);
  result.gap = separation.distance;
}

}  // namespace

double toleranceOf(const Query& query, const Mesh& sensor) {
  if (query.clearance == 0) return 0;
  const Box box = boxOf(sensor, query.worldFromMesh.m);
  const double side = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
  // Without a wish, a ball's is as narrow as rounding allows.
  if (!query.tolerance) return kTolerance * side;
  return std::min(*query.tolerance, kTolerance * std::max(side, query.clearance));
}

ClearanceContact::ClearanceContact(const Query& query, const Motion& motion, double tolerance)
    : PairVisitor(motion.distance),
      query_(query),
      motion_(&motion),
      tolerance_(tolerance),
      lo_(std::numeric_limits<double>::infinity()) {}

bool ClearanceContact::Near::isCertain() const {
  return !std::isinf(approach.hi);
}

// Certain approaches come before open ones.
bool ClearanceContact::Near::precedes(const Near& other) const {
  if (approach.hi != other.approach.hi) return approach.hi < other.approach.hi;
  if (!isCertain() && approach.lo != other.approach.lo) return approach.lo < other.approach.lo;
  return name < other.name;
}

std::optional<Approach> ClearanceContact::approachOf(const exact::PlacedPair& pair, Vector* across) const {
  const Motion& motion = *motion_;
  auto found = approach(pair.a, pair.b, motion.direction, motion.unit, query_.clearance,
                        motion.wayUntil(motion.distance), tolerance_, across);
  if (!found) return found;
  if (motion.isStep) {
    const auto timeOf = [&](double way, double rounding) {
      return way > 0 && motion.speed > 0 ? rounding * (way / motion.speed) : 0;
    };
    found->lo = timeOf(found->lo, 1 - 4 * kUnit);
    if (!std::isinf(found->hi)) found->hi = timeOf(found->hi, 1 + 4 * kUnit);
    if (found->lo > motion.distance) return std::nullopt;
    // The way until then has been rounded: only the end itself is known to be in time.
    const bool isLate = found->hi > motion.distance && !std::isinf(found->hi);
    if (isLate && certainlyWithin(pair.a, pair.b, motion.direction, query_.clearance)) {
      found->hi = motion.distance;
    } else if (isLate) {
      found->hi = std::numeric_limits<double>::infinity();
    }
  }
  // No digits tell how far a tiny clearance is; but what touches is within it.
  if (std::isinf(found->hi)) {
    exact::EarliestContact touching(motion);
    touching.consider({}, pair);
    if (!touching.found()) return found;
    const Result result = touching.answer(false);
    found->hi = result.hi;
    found->lo = std::min(found->lo, found->hi);
    found->atLo = {0, result.point, result.normal, {result.featureA, result.featureB}};
    return found;
  }
  if (motion.isStep) found->atLo.point = along(found->atLo.point, found->lo, motion.drift);
  return found;
}

bool ClearanceContact::hasSunkIn(const exact::PlacedPair& pair) const {
  if (!rule_.arePressed(pair, *motion_)) return false;
  exact::EarliestContact touching(*motion_);
  touching.considerPressed({}, pair);
  return touching.found() && touching.overlaps();
}

void ClearanceContact::consider(const exact::PairName& name, const exact::PlacedPair& pair, Axis) {
  if (isBefore(name)) return;
  const double reach = std::max(query_.clearance, query_.ignoreLeaving ? 2 * rule_.slack : 0);
  const Vector displacement = scaled(motion_->wayUntil(latest_), motion_->unit);
  if (across_ != Vector{} && stayApart(pair.a, pair.b, across_, displacement, reach)) return;
  auto found = approachOf(pair, best_.empty() ? &across_ : nullptr);
  if (query_.ignoreLeaving && query_.clearance <= 2 * rule_.slack && hasSunkIn(pair)) {
    found = Approach{0, 0, separationOf(pair.a, pair.b)};
  }
  if (!found) return;
  Near near{name, *found, found->lo};
  const bool matters = best_.empty() || near.lo < best_[0].lo || near.precedes(best_[0]);
  if (!matters || (query_.ignoreLeaving && !rule_.blocks(pair, *motion_, query_.clearance))) return;
  lo_ = std::min(lo_, near.lo);
  if (best_.empty()) {
    best_.push_back(near);
  } else {
    near.lo = best_[0].lo = std::min(near.lo, best_[0].lo);
    if (!near.precedes(best_[0])) return;
    best_[0] = near;
  }
  if (near.isCertain() && !std::isnan(near.approach.atLo.normal[0])) across_ = near.approach.atLo.normal;
  atStart_ = near.approach.hi == 0;
  // What is within the clearance at the start is named by NearestAtStart.
  decided_ = near.isCertain() && (query_.anyHit || (atStart_ && query_.hits == 1));
  first_ = {name.object, 0, 0};
  // A later pair may have a bracket that begins before this one's, which then widens that of the answer.
  latest_ = std::min(latest_, near.approach.hi + (motion_->isStep ? 0 : tolerance_));
}

void ClearanceContact::endObject() {
  if (query_.hits == 1 || best_.empty()) return;
  if (best_[0].isCertain()) {
    latest_ = std::min(motion_->distance, addNearest(nearest_, query_.hits, best_[0]));
    atStart_ = false;
  } else {
    open_.push_back(best_[0]);
  }
  best_.clear();
}

Result ClearanceContact::answer(const Near& near) const {
  Result result(!near.isCertain() ? Status::undecided : near.approach.hi == 0 ? Status::overlap : Status::hit);
  result.lo = near.lo;
  result.object = near.name.object;
  if (!near.isCertain()) return result;
  result.detected = Detected::yes;
  result.t = near.lo;
  result.hi = near.approach.hi;
  result.fraction = motion_->distance > 0 ? result.t / motion_->distance : 0;
  result.triB = near.name.triB;
  result.triA = near.name.triA;
  setSeparation(result, near.approach.atLo);
  return result;
}

Result ClearanceContact::first() const {
  const std::vector<Near>& found = !nearest_.empty() ? nearest_ : !best_.empty() ? best_ : open_;
  if (found.empty()) return Result(Status::clear);
  Near first = found[0];
  first.lo = lo_;
  if (first.isCertain() && !query_.anyHit) return answer(first);
  // No ids, as of any decision and of what is undecided.
  Result result(first.isCertain() ? Status::hit : Status::undecided);
  result.lo = first.isCertain() ? 0 : lo_;
  if (first.isCertain()) result.t = result.hi = motion_->distance;
  if (first.isCertain()) result.fraction = motion_->distance > 0 ? 1 : 0;
  if (first.isCertain()) result.detected = Detected::yes;
  return result;
}

std::vector<Result> ClearanceContact::nearest() const {
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

void NearestAtStart::consider(const exact::PairName& name, const exact::PlacedPair& pair) {
  if (isBefore(name)) return;
  const Separation found = separationOf(pair.a, pair.b);
  const bool isNearer = found.distance < nearest_.distance || (found.distance == nearest_.distance && name < name_);
  if (!isNearer) return;
  if (query_.ignoreLeaving && !rule_.blocks(pair, *motion_, query_.clearance)) return;
  nearest_ = found;
  name_ = name;
  // Another one's distance may be rounded down to the same.
  reach_ = (1 + 0x1p-20) * found.distance;
}

void NearestAtStart::describe(Result& result) const {
  if (name_.object == kNone) return;
  result.object = name_.object;
  result.triB = name_.triB;
  result.triA = name_.triA;
  setSeparation(result, nearest_);
}

}  // namespace radar::cpu
