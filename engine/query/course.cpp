#include "query/course.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "radar/displacement.h"

namespace radar {

namespace {

/// NaN if a component is, and nearer to the length than std::hypot of three.
double lengthOfWay(const Vector& way) {
  return std::hypot(std::hypot(way[0], way[1]), way[2]);
}

}  // namespace

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
  if (!isStep_ || query_.motion || query_.turn) return;
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

std::array<double, 3> displacementOf(const Query& query) {
  if (query.motion || query.turn) return query.motion.value_or(Vector{});
  const Translation sweep(query);
  return scaled(sweep.end, sweep.unit);
}

void setDisplacement(Query& query, const std::array<double, 3>& way, Mode mode, bool objectsMove) {
  const bool isAlongAxis = (way[0] == 0) + (way[1] == 0) + (way[2] == 0) == 2;
  const bool mayRoundUp = mode == Mode::sampled || (query.clearance > 0 && !objectsMove);
  // A step needs no length, which takes as long as all else here.
  const double length = isAlongAxis || mayRoundUp ? lengthOfWay(way) : 0;
  query.motion.reset();
  if (mode == Mode::sampled && length == 0) {
    query.direction = {0, 0, 1};  // no direction changes whether the surfaces meet at the start
    query.distance = 0;
  } else if (isAlongAxis && length <= kMostMotion) {
    for (size_t k = 0; k < 3; ++k) query.direction[k] = way[k] / length;
    query.distance = length;
  } else if (mayRoundUp && (mode == Mode::sampled || (length > 0 && length <= kMostMotion))) {
    query.direction = way;
    query.distance = std::nextafter((1 + 0x1p-50) * length, std::numeric_limits<double>::infinity());
  } else {
    query.motion = way;
    query.direction = {};
    query.distance = 0;
  }
}

void toDistances(const Query& query, Result& result) {
  if (!query.motion || query.turn || std::isinf(result.lo)) return;
  // The length rounds, as products do; the floor is what a subnormal product loses.
  constexpr double kRoom = 0x1p-50, kFloor = std::numeric_limits<double>::denorm_min();
  const double length = lengthOfWay(*query.motion);
  const auto scaled = [&](double time) { return time == 0 || std::isinf(time) ? time : time * length; };
  const bool isLo = result.t == result.lo && result.lo < result.hi;
  if (length == 0) result.hi = std::isinf(result.hi) ? result.hi : 0;
  result.lo = std::max((1 - kRoom) * scaled(result.lo) - kFloor, 0.0);
  result.t = isLo ? result.lo : scaled(result.t);
  result.hi = result.hi == 0 ? 0 : (1 + kRoom) * scaled(result.hi) + kFloor;
}

}  // namespace radar
