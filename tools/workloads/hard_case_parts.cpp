#include "workloads/hard_case_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "workloads/generate.h"
#include "workloads/random_shapes.h"
#include "workloads/shapes.h"

namespace radar::tools {

Transform at(const Vec3& where) {
  return makePose(kUpright, kFull, where);
}

Vec3 farOrigin(Random& random) {
  const double distance = magnitude(random, 1, 7);
  return scaled(random.direction(), distance);
}

Rotation tilt(double tangent) {
  const double c = 1 / std::sqrt(1 + tangent * tangent), s = c * tangent;
  return {1, 0, 0, 0, c, -s, 0, s, c};
}

Rotation roll(Random& random) {
  const auto [c, s] = circlePoint(random.below(360), 360);
  return {c, -s, 0, s, c, 0, 0, 0, 1};
}

MeshData resized(MeshData mesh, double factor) {
  for (float& value : mesh.positions) value = static_cast<float>(value * factor);
  return mesh;
}

double reachFor(double gap, Random& random) {
  constexpr std::array<double, 4> kParts{0.7, 1.5, 3, 20};
  return gap * kParts[random.below(4)];
}

PlacedMesh compact(Random& random, const Vec3& middle) {
  const uint32_t which = random.below(4);
  MeshData mesh = which == 0   ? makeBox({1, 0.8, 0.6})
                  : which == 1 ? makeUvSphere(5, 8)
                  : which == 2 ? makeTorus(0.4, 0.15, 12, 6)
                               : makeHook(1, 0.5, 0.4, 0.15);
  if (which == 1) mesh = resized(std::move(mesh), 0.5);
  const auto rotation = random.oneIn(3) ? kUpright : random.rotation();
  return {std::move(mesh), makePose(rotation, kFull, middle)};
}

Transform anyPose(Random& random, const Vec3& where) {
  if (random.oneIn(4)) return randomAffine(random, where);
  const Rotation rotation = random.rotation();
  return makePose(rotation, kFull, where);
}

HardCase pairOf(MakeShape sensor, MakeShape object, Random& random) {
  HardCase hard;
  hard.sensor.mesh = sensor(random);
  hard.sensor.worldFromMesh = anyPose(random, {});
  MeshData mesh = object(random);
  const Vec3 where = random.inBox({-1.2, -1.2, 0.5}, {1.2, 1.2, 5});
  hard.objects.push_back({std::move(mesh), anyPose(random, where)});
  hard.distance = random.oneIn(10) ? 0 : reachFor(where[2], random);
  return hard;
}

HardCase anyPair(Random& random) {
  return pairOf(anyShape, anyShape, random);
}

HardCase blocks(uint32_t grazing, double gap, Random& random) {
  const Block a = block(random), b = block(random);
  Vec3 where{0, 0, a.reach[2] + b.reach[2] + gap};
  const uint32_t first = random.below(2);
  for (uint32_t k = 0; k < 2; ++k) {
    const bool touches = grazing > (k == first ? 0u : 1u);
    where[k] = touches ? a.reach[k] + b.reach[k] : 0.25 * random.below(3);
    if (random.oneIn(2)) where[k] = -where[k];
  }
  return {{a.mesh, {}}, {{b.mesh, at(where)}}, {0, 0, 1}, std::max(gap, 0.0) + 3};
}

}  // namespace radar::tools
