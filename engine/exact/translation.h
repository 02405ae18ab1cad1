// The straight motion of one query, or past one object, in double precision.
#pragma once

#include <algorithm>

#include "math/rounding.h"
#include "math/vector.h"
#include "radar/query.h"

namespace radar {

/// A part of the sensor's way past an object, on which each of its points moves along one direction at one rate, or
/// stays near where that would take it.
struct Piece {
  Vector unit{};         ///< of length 1; the error of each component is at most 8u of it plus 2^-1074
  double from = 0;       ///< t at its start
  double end = 0;        ///< t at its end
  double rate = 1;       ///< world units per unit of t, rounded up
  double deviation = 0;  ///< world units: no point is ever farther from where the straight motion takes it

  /// Upper bound on the straight motion from the piece's start until `t`, or its end, world units.
  double wayUntil(double t) const { return rate * (std::min(t, end) - from); }
};

/// The sensor's motion relative to an object, if that is straight. In a sweep, t is the distance moved; in a step, in
/// which objects may move, too, the fraction of the step.
struct Translation : Piece {
  Vector direction;  ///< not zero. Sweep: the query's, scaled by a power of two to a largest component of 1 to 2, if
                     ///< that is exact. Step: the displacement, unless it is zero
  double length;     ///< what one `direction` adds to t. Sweep: its length, rounded to the nearest double; step: 1
  double parameter;  ///< contact at any lesser multiple of `direction` is before the end
  double speed = 1;  ///< world units per unit of t
  bool isStep = false;
  bool stands = false;  ///< a step without relative motion
  Vector drift{};       ///< step: the object's displacement

  /// A sweep.
  explicit Translation(const Query& query);
  /// A step in which the sensor moves by `sensor` and the object by `object`, both at most 2^1000.
  Translation(const Vector& sensor, const Vector& object);
};

}  // namespace radar
