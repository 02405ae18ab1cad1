#include "cpu/turn_motion.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

// A point that is `radius` from the axis, in a part of which the angle is `by` and the straight motion `way`, and as
// seen from a body that turns: second derivatives, over 8.
double bendOf(double radius, double by) {
  return radius * by * by / 8;
}
double bendSeenFromBody(double radius, double by, double way) {
  return bendOf(radius + way, by) + by * way / 4;
}

}  // namespace

TurnMotion::TurnMotion(const Query& query, const Mesh& sensor) : turning_(query) {
  const Transform& pose = query.worldFromMesh;
  const Box box = boxOf(sensor, pose.m);
  Vector middle, half;
  for (int k = 0; k < 3; ++k) {
    middle[k] = box.middle(k);
    half[k] = box.hi[k] - middle[k];
  }
  const double reach = norm(half), arm = norm(minus(middle, turning_.centre())) + reach;
  radius_ = (1 + 0x1p-40) * (turning_.radius(middle) + reach + query.clearance) + 0x1p-40 * arm;
  const Vector& way = turning_.way();
  const double angle = turning_.angle(), length = norm(way);
  const double allowed = std::max(bendAllowed(sensor, pose, reach), 0x1p-14 * (radius_ + length));
  const double count =
      partsOf(angle, allowed, [&](double share) { return bendSeenFromBody(radius_, share * angle, share * length); });

  double terms = norm(minus({pose.m[3], pose.m[7], pose.m[11]}, turning_.centre()));
  for (int k = 0; k < 3; ++k) terms += norm({pose.m[k], pose.m[4 + k], pose.m[8 + k]}) * sensor.span()[k];
  const double error = turning_.errorFor(terms, way) + 8 * kUnit * (terms + norm1(turning_.centre()) + norm1(way));
  const auto poseAt = [&](double s) { return turning_.pose(pose, s, way); };
  Transform last = pose;
  Vector lastMiddle = middle;
  parts_.reserve(static_cast<size_t>(count));
  for (double i = 0; i < count; ++i) {
    const double from = i / count, end = i + 1 < count ? (i + 1) / count : 1;
    const Transform next = poseAt(end);
    const Vector nextMiddle = along(middle, 1, turning_.displacement(middle, end, way));
    const double bend = bendOf(radius_, (1 + 0x1p-40) * angle * (end - from));
    parts_.emplace_back(sensor, PathPart::End{from, last, lastMiddle}, PathPart::End{end, next, nextMiddle}, bend,
                        error);
    last = next;
    lastMiddle = nextMiddle;
  }
}

double TurnMotion::speedPast(const Vector& objectWay) const {
  return (1 + 0x1p-40) * (turning_.angle() * radius_ + norm(minus(turning_.way(), objectWay)));
}

double TurnMotion::bendSeen(const PathPart& part, const Vector& objectWay) const {
  const double share = (1 + 0x1p-40) * (part.end - part.from);
  return bendSeenFromBody(radius_, turning_.angle() * share, norm(minus(turning_.way(), objectWay)) * share);
}

}  // namespace radar::cpu
