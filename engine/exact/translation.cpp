#include "exact/translation.h"

#include <cmath>

#include "exact/contact.h"
#include "math/frame.h"

namespace radar {

namespace {

// Below this, the relative error of a length or a quotient may exceed its rounding error.
constexpr double kLeastNormal = 0x1p-900;

}  // namespace

Translation::Translation(const Query& query)
    : direction(scaledDirection(query.direction)), length(exact::length(direction)), parameter(0) {
  unit = normalized(direction);
  end = query.distance;
  const double quotient = end / length;
  if (length > kLeastNormal && quotient > kLeastNormal) parameter = (1 - 8 * kUnit) * quotient;
}

Translation::Translation(const Vector& sensor, const Vector& object)
    : direction(minus(sensor, object)), length(1), parameter(1 - 4 * kUnit), isStep(true), drift(object) {
  end = 1;
  stands = direction == Vector{};
  if (stands) {
    direction = {1, 0, 0};
    parameter = speed = 0;
  } else {
    speed = lengthOf(direction);
  }
  unit = normalized(direction);
  rate = (1 + 8 * kUnit) * speed;
}

}  // namespace radar
