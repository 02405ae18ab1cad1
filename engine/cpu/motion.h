// The motion of one query.
#pragma once

#include "exact/contact.h"
#include "radar/radar.h"

namespace radar::cpu {

/// 2^-53: what a double loses in an operation, at most, relative to the result.
inline constexpr double kUnit = 0x1p-53;

struct Motion {
  Vector direction;  ///< the query's, times a power of two that makes its largest component 1 to 2 where that is exact
  Vector unit;       ///< of length 1; each component is off by at most 8u of itself and 2^-1074
  double length;     ///< of `direction`, rounded to the nearest double
  double distance;   ///< D
  double parameter;  ///< whatever meets at a parameter, in terms of `direction`, below it meets before D

  explicit Motion(const Query& query);
};

}  // namespace radar::cpu
