#include "query/course.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace radar {

Course::Course(const Query& query, const Scene::Impl& scene)
    : query_(query),
      scene_(scene),
      isStep_(radar::isStep(query, scene)),
      displacement_(isStep_ ? displacementOf(query) : Vector{}) {}

Translation Course::past(ObjectId object) const {
  if (!isStep_) return Translation(query_);
  return {displacement_, object == kNone ? Vector{} : scene_.objects[object].object.motion};
}

void Course::toQuery(Result& result) const {
  if (!isStep_ || query_.motion) return;
  // A bracket's ends are equal only at the start or the end. The floor is what a product may lose if it is subnormal.
  const double distance = query_.distance;
  const bool isExact = result.lo == result.hi;
  const double rounding = isExact ? 0 : 2 * kUnit, floor = isExact ? 0 : std::numeric_limits<double>::denorm_min();
  const auto scaled = [&](double t, double outwards) { return std::isinf(t) ? t : outwards * t * distance; };
  const bool isLo = result.t == result.lo;
  result.lo = std::max(scaled(result.lo, 1 - rounding) - floor, 0.0);
  result.t = isLo ? result.lo : scaled(result.t, 1);
  result.hi = std::isinf(result.hi) ? result.hi : std::min(scaled(result.hi, 1 + rounding) + floor, distance);
}

}  // namespace radar
