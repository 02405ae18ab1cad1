// The motion of one query, or past one object, in double precision.
#pragma once

#include "math/rounding.h"
#include "math/vector.h"
#include "radar/query.h"

namespace radar {

/// The sensor's motion relative to an object. In a sweep, t is the distance moved; in a step, in which objects may
/// move, too, the fraction of the step.
struct Motion {
  Vector direction;  ///< not zero. Sweep: the query's, scaled by a power of two to a largest component of 1 to 2, if
                     ///< that is exact. Step: the displacement, unless it is zero
  Vector unit;       ///< of length 1; the error of each component is at most 8u of it plus 2^-1074
  double length;     ///< what one `direction` adds to t. Sweep: its length, rounded to the nearest double; step: 1
  double distance;   ///< t at the end. Sweep: D; step: 1
  double parameter;  ///< contact at any lesser multiple of `direction` is before the end
  double speed = 1;  ///< world units per unit of t
  bool isStep = false;
  bool stands = false;  ///< a step without relative motion
  Vector drift{};       ///< step: the object's displacement

  /// A sweep.
  explicit Motion(const Query& query);
  /// A step in which the sensor moves by `sensor` and the object by `object`, both at most 2^1000.
  Motion(const Vector& sensor, const Vector& object);

  /// Upper bound on the relative motion until `t`, world units.
  double wayUntil(double t) const { return isStep ? (1 + 8 * kUnit) * (speed * t) : t; }
};

/// The sensor's displacement during a step: the query's motion, or D along its direction.
Vector displacementOf(const Query& query);

}  // namespace radar
