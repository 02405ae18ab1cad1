#include "exact/motion.h"

#include <cmath>

#include "exact/contact.h"
#include "math/frame.h"

namespace radar {

namespace {

// Below this, the relative error of a length or a quotient may exceed its rounding error.
constexpr double kLeastNormal = 0x1p-900;

Vector normalized(Vector v) {
  const double size = largest(v);
  for (double& c : v) c /= size;
  const double length = std::sqrt(dot(v, v));
  for (double& c : v) c /= length;
  return v;
}

}  // namespace

Motion::Motion(const Query& query)
    : direction(scaledDirection(query.direction)),
      unit(normalized(direction)),
      length(exact::length(direction)),
      distance(query.distance),
      parameter(0) {
  const double quotient = distance / length;
  if (length > kLeastNormal && quotient > kLeastNormal) parameter = (1 - 8 * kUnit) * quotient;
}

Motion::Motion(const Vector& sensor, const Vector& object)
    : direction(minus(sensor, object)), length(1), distance(1), parameter(1 - 4 * kUnit), isStep(true), drift(object) {
  stands = direction == Vector{};
  if (stands) {
    direction = {1, 0, 0};
    parameter = speed = 0;
  } else {
    speed = lengthOf(direction);
  }
  unit = normalized(direction);
}

Vector displacementOf(const Query& query) {
  if (query.motion) return *query.motion;
  const Motion sweep(query);
  return scaled(sweep.distance, sweep.unit);
}

}  // namespace radar
