// The motion of one query, in double precision.
#pragma once

#include "math/vector.h"
#include "radar/radar.h"

namespace radar {

/// 2^-53: bound on the relative rounding error of an operation in double.
inline constexpr double kUnit = 0x1p-53;

struct Motion {
  Vector direction;  ///< the query's, scaled by a power of two to a largest component of 1 to 2, if that is exact
  Vector unit;       ///< of length 1; the error of each component is at most 8u of it plus 2^-1074
  double length;     ///< of `direction`, rounded to the nearest double
  double distance;   ///< D
  double parameter;  ///< contact at any lesser multiple of `direction` is before D

  explicit Motion(const Query& query);
};

}  // namespace radar
