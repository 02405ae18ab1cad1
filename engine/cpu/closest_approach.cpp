#include "cpu/closest_approach.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "cpu/bracketed_contact.h"

namespace radar::cpu {

ClosestApproach::ClosestApproach() : NearVisitor(std::numeric_limits<double>::infinity()) {}

void ClosestApproach::consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                               const PairRule&) {
  const Vector displacement = scaled(motion.wayUntil(motion.end), motion.unit);
  if (across_ != Vector{} && stayApart(pair.a, pair.b, across_, displacement, reach_)) return;
  const std::optional<Passage> found = passage(pair.a, pair.b, motion, reach_);
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
  // Pairs whose brackets begin before this one's matter, too.
  reach_ = (1 + 0x1p-20) * found->hi;
}

}  // namespace radar::cpu
