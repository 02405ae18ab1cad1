#include "sampled/contact_point.h"

#include <cmath>
#include <limits>

#include "shaders/sampled/interop.h"

namespace radar {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The unit normal of x and y, against the motion; NaN if they are parallel.
Vector normalOf(const Vector& x, const Vector& y, const Vector& direction) {
  Vector n = cross(x, y);
  const double length = lengthOf(n) * (dot(n, direction) > 0 ? -1 : 1);
  if (length == 0) return {kNaN, kNaN, kNaN};
  for (double& c : n) c /= length;
  return n;
}

// The point on the edge from q to q + y at which the sensor's edge from p to p + x crosses it at the contact; computed
// from areas seen along the motion.
Vector crossing(const Vector& p, const Vector& x, const Vector& q, const Vector& y, const Vector& direction) {
  const Vector side = cross(x, direction);
  return along(q, dot(side, minus(p, q)) / dot(side, y), y);
}

}  // namespace

void describe(Result& result, uint32_t feature, const Corners& a, const Corners& b, const Vector& direction) {
  const double length = lengthOf(direction);
  const Vector unit{direction[0] / length, direction[1] / length, direction[2] / length};
  if (feature < 3) {
    result.featureA = Feature::vertex;
    result.featureB = Feature::face;
    result.point = along(a[feature], result.t, unit);
    result.normal = normalOf(minus(b[1], b[0]), minus(b[2], b[0]), unit);
  } else if (feature < gpu::kFeatureEdges) {
    result.featureA = Feature::face;
    result.featureB = Feature::vertex;
    result.point = b[feature - 3];
    result.normal = normalOf(minus(a[1], a[0]), minus(a[2], a[0]), unit);
  } else {
    result.featureA = result.featureB = Feature::edge;
    const uint32_t i = (feature - gpu::kFeatureEdges) / 3, j = (feature - gpu::kFeatureEdges) % 3;
    const Vector x = minus(a[kEdgeTo[i]], a[kEdgeFrom[i]]), y = minus(b[kEdgeTo[j]], b[kEdgeFrom[j]]);
    result.point = crossing(a[kEdgeFrom[i]], x, b[kEdgeFrom[j]], y, unit);
    result.normal = normalOf(x, y, unit);
  }
}

}  // namespace radar
