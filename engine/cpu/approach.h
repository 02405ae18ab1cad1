// When two triangles, one of them in motion, come within a given distance of each other: certified bounds in doubles.
#pragma once

#include <optional>

#include "exact/contact.h"

namespace radar::cpu {

struct Approach {
  double lo;                 ///< world units: the triangles are farther apart before this
  double hi;                 ///< they certainly are within the distance by this; infinite if rounding leaves it open
  Vector point;              ///< of the resting triangle, nearest to the moving one at `lo`; a corner is given exactly
  Vector normal;             ///< unit, from the resting triangle towards the moving one at `lo`; NaN if they touch
  exact::Features features;  ///< on which the nearest points at `lo` are
};

/// When triangle a, moved by t along `direction`, comes within `clearance` > 0 of b; none if it certainly does not for
/// 0 <= t <= `distance`. hi - lo is at most `tolerance`, if rounding allows. `unit` is Motion::unit.
std::optional<Approach> approach(const exact::Triangle& a, const exact::Triangle& b, const Vector& direction,
                                 const Vector& unit, double clearance, double distance, double tolerance);

}  // namespace radar::cpu
