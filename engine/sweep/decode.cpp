#include "sweep/decode.h"

#include <cmath>
#include <limits>

#include "sweep/frame.h"

namespace radar {

namespace {

constexpr double kNull = std::numeric_limits<double>::quiet_NaN();

using Corners = std::array<Vector, 3>;

Corners corners(const Mesh& mesh, const Pose& pose, uint32_t triangle) {
  Corners p;
  for (int i = 0; i < 3; ++i) p[i] = place(pose, &mesh.positions[3 * size_t{mesh.indices[3 * size_t{triangle} + i]}]);
  return p;
}

Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

Vector plus(const Vector& a, const Vector& b, double scale) {
  return {a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]};
}

// Unit, against the motion; null where x and y are parallel.
Vector normalOf(const Vector& x, const Vector& y, const Vector& direction) {
  Vector n{x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]};
  const double length = lengthOf(n) * (dot(n, direction) > 0 ? -1 : 1);
  if (length == 0) return {kNull, kNull, kNull};
  for (double& c : n) c /= length;
  return n;
}

// Where edge p + x of the sensor, moved to the contact, crosses edge q + y: the point on y, by areas seen along the
// motion.
Vector crossing(const Vector& p, const Vector& x, const Vector& q, const Vector& y, const Vector& direction) {
  const Vector side{x[1] * direction[2] - x[2] * direction[1], x[2] * direction[0] - x[0] * direction[2],
                    x[0] * direction[1] - x[1] * direction[0]};
  return plus(q, y, dot(side, minus(p, q)) / dot(side, y));
}

// The point and normal of what attains the contact (shaders/interop.h, "Features"), after moving `travel` along unit.
void describe(Result& result, uint32_t feature, const Corners& a, const Corners& b, const Vector& unit) {
  if (feature < 3) {
    result.point = plus(a[feature], unit, result.t);
    result.normal = normalOf(minus(b[1], b[0]), minus(b[2], b[0]), unit);
  } else if (feature < gpu::kFeatureEdges) {
    result.point = b[feature - 3];
    result.normal = normalOf(minus(a[1], a[0]), minus(a[2], a[0]), unit);
  } else {
    const uint32_t i = (feature - gpu::kFeatureEdges) / 3, j = (feature - gpu::kFeatureEdges) % 3;
    const Vector x = minus(a[(i + 1) % 3], a[i]), y = minus(b[(j + 1) % 3], b[j]);
    result.point = crossing(a[i], x, b[j], y, unit);
    result.normal = normalOf(x, y, unit);
  }
}

}  // namespace

Result decodeClear() {
  Result result;
  result.status = Status::clear;
  result.tier = Tier::select;
  result.detected = Detected::no;
  return result;
}

Result decode(const gpu::Answer& answer, const Query& query, const Scene::Impl& scene, uint32_t resolution) {
  Result result;
  result.tier = Tier::sampled;
  result.resolution = resolution;
  result.lo = 0;
  result.detected = (answer.flags & gpu::kAnswerDetected) != 0 ? Detected::yes : Detected::no;
  if ((answer.flags & gpu::kAnswerHasL) != 0) result.paperMinL = answer.minL;
  result.status = Status::undecided;
  if (answer.object == kNone) return result;

  result.status = answer.hi == 0 ? Status::overlap : Status::hit;
  result.t = result.hi = answer.hi;
  result.fraction = query.distance > 0 ? answer.hi / query.distance : 0;
  result.object = answer.object;
  result.triB = answer.triB;
  result.triA = answer.triA;
  if (result.status == Status::overlap) return result;  // the surfaces already cross: no first point of contact
  const double length = lengthOf(query.direction);
  const Vector unit{query.direction[0] / length, query.direction[1] / length, query.direction[2] / length};
  const Object& object = scene.objects[answer.object].object;
  describe(result, answer.feature, corners(scene.meshes[query.mesh], query.worldFromMesh, answer.triA),
           corners(scene.meshes[object.mesh], object.worldFromMesh, answer.triB), unit);
  return result;
}

}  // namespace radar
