#include "cpu/closest_approach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cpu/bracketed_contact.h"

namespace radar::cpu {

namespace {

// Of brackets.
constexpr double kRoom = 8;

}  // namespace

ClosestApproach::ClosestApproach() : NearVisitor(std::numeric_limits<double>::infinity()) {}

void ClosestApproach::consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                               const PairRule&) {
  ++considered_;
  const Vector displacement = scaled(motion.wayUntil(motion.end), motion.unit);
  if (across_ != Vector{} && stayApart(pair.a, pair.b, across_, displacement, closest_.hi)) return;
  const std::optional<Passage> found = passage(pair.a, pair.b, motion, closest_.hi);
  if (!found) return;
  closest_.lo = std::min(closest_.lo, found->lo);
  const Result& best = closest_.at;
  const exact::PairName named{best.object, best.triB, best.triA};
  if (std::tie(closest_.hi, named) < std::tie(found->hi, name)) return;
  closest_.hi = found->hi;
  Result& at = closest_.at;
  at = Result(Status::clear);
  at.object = name.object;
  at.triB = name.triB;
  at.triA = name.triA;
  const double t = motion.isStep && motion.speed > 0 ? found->way / motion.speed : found->way;
  at.t = at.lo = at.hi = std::min(t, motion.end);
  at.fraction = motion.end > 0 ? at.t / motion.end : 0;
  setSeparation(at, found->at);
  if (motion.isStep) at.point = exact::withoutZeroSigns(along(at.point, at.t, motion.drift));
  if (!std::isnan(at.normal[0])) across_ = at.normal;
  // Nodes' bounds round, too: pairs that are as near to rounding, as of faces that slide along each other, may be very
  // many, and change the bracket by no more than this.
  reach_ = std::max(found->lo - kRoom * (found->hi - found->lo), 0.0);
}

Closest ClosestApproach::answer() const {
  Closest closest = closest_;
  closest.lo = std::min(closest.lo, skipped_);
  return closest;
}

}  // namespace radar::cpu
