#include "cpu/clearance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "exact/event.h"

namespace radar::cpu {

namespace {

// Of the longest side of the sensor's box, or of the clearance.
constexpr double kTolerance = 1e-6;

}  // namespace

double toleranceOf(const Query& query, const Mesh& sensor) {
  if (query.clearance == 0) return 0;
  const Box box = boxOf(sensor, query.worldFromMesh.m);
  const double side = std::max({box.hi[0] - box.lo[0], box.hi[1] - box.lo[1], box.hi[2] - box.lo[2]});
  // Without a wish, a ball's is as narrow as rounding allows.
  if (!query.tolerance) return kTolerance * side;
  return std::min(*query.tolerance, kTolerance * std::max(side, query.clearance));
}

ClearanceContact::ClearanceContact(const Query& query, const Translation& motion, double tolerance)
    : BracketedContact(query, motion.end, motion.isStep ? 0 : tolerance), motion_(&motion), tolerance_(tolerance) {}

std::optional<Approach> ClearanceContact::approachOf(const exact::PlacedPair& pair, Vector* across) const {
  const Translation& motion = *motion_;
  auto found = approach(pair.a, pair.b, motion, query_.clearance, tolerance_, latest_, across);
  if (!found) return found;
  if (motion.isStep) {
    const auto timeOf = [&](double way, double rounding) {
      return way > 0 && motion.speed > 0 ? rounding * (way / motion.speed) : 0;
    };
    found->lo = timeOf(found->lo, 1 - 4 * kUnit);
    if (!std::isinf(found->hi)) found->hi = timeOf(found->hi, 1 + 4 * kUnit);
    if (found->lo > motion.end) return std::nullopt;
    // The way until then has been rounded: only the end itself is known to be in time.
    const bool isLate = found->hi > motion.end && !std::isinf(found->hi);
    if (isLate && certainlyWithin(pair.a, pair.b, motion.direction, query_.clearance)) {
      found->hi = motion.end;
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

std::optional<Approach> ClearanceContact::bracketOf(const exact::PairName&, const exact::PlacedPair& pair) {
  if (query_.ignoreLeaving && rule_.leaves(pair, *motion_, query_.clearance)) return std::nullopt;
  const double reach = std::max(query_.clearance, query_.ignoreLeaving ? 2 * rule_.slack : 0);
  const Vector displacement = scaled(motion_->wayUntil(latest_), motion_->unit);
  if (across_ != Vector{} && stayApart(pair.a, pair.b, across_, displacement, reach)) return std::nullopt;
  auto found = approachOf(pair, hasFound() ? nullptr : &across_);
  if (query_.ignoreLeaving && query_.clearance <= 2 * rule_.slack && hasSunkIn(pair)) {
    found = Approach{0, 0, separationOf(pair.a, pair.b)};
  }
  return found;
}

bool ClearanceContact::counts(const exact::PlacedPair& pair) const {
  return !query_.ignoreLeaving || rule_.blocks(pair, *motion_, query_.clearance);
}

void NearestAtStart::consider(const exact::PairName& name, const exact::PlacedPair& pair, const Translation& motion,
                              const PairRule& rule) {
  if (isBefore(name) || (query_.ignoreLeaving && rule.leaves(pair, motion, query_.clearance))) return;
  const Separation found = separationOf(pair.a, pair.b);
  const bool isNearer = found.distance < nearest_.distance || (found.distance == nearest_.distance && name < name_);
  if (!isNearer) return;
  if (query_.ignoreLeaving && !rule.blocks(pair, motion, query_.clearance)) return;
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
