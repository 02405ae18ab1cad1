#include "contact/sensors.h"

#include <algorithm>
#include <cmath>

#include "cpu/clearance.h"
#include "exact/blocking.h"
#include "math/frame.h"
#include "math/rounding.h"
#include "query/swept.h"
#include "scene/placement.h"

namespace radar {

namespace {

// A sensor smaller than this share of the scene's extent is scaled to less than 1, so that distances stay below 2^40.
constexpr double kLeastShare = 0x1p-38;
// Scaled. Longer distances are clipped to this: by kLeastShare, every contact is nearer.
constexpr double kMostDistance = 0x1p42;
// Scaled. Shorter distances, other than 0, are out of range: floats might flush them to 0, which would make contact
// before D indistinguishable from contact at D.
constexpr double kLeastDistance = 0x1p-100;
// Scaled. Larger clearances are left to the CPU, for node_pair.glsl multiplies such lengths; so are clearances below
// this share of the scene's extent, which the CPU's doubles may be unable to tell from 0.
constexpr double kMostClearance = 0x1p29, kLeastClearance = 0x1p-40;

// Distance from `centre` to the farthest point of the scene, as a sum over the axes.
double farthestOf(const Box& world, const Vector& centre) {
  double sum = 0;
  for (int k = 0; k < 3; ++k) sum += std::max(std::abs(world.lo[k] - centre[k]), std::abs(world.hi[k] - centre[k]));
  return sum;
}

// The sensor's box in the world, widened by the rounding of its centre to float and by the change of direction
// components that sensorBoxOf (nodes.glsl) raises above 0, over the whole distance.
void setBox(gpu::Sensor& out, const Box& box, const Vector& anchor, double farthest) {
  for (int k = 0; k < 3; ++k) {
    out.centre[k] = static_cast<float>(box.middle(k) - anchor[k]);
    const double half = 0.5 * (box.hi[k] - box.lo[k]) + 0x1p-50 * (std::abs(box.lo[k]) + std::abs(box.hi[k]));
    out.halfExtent[k] = roundUp(half + 0x1p-23 * std::abs(out.centre[k]) + 0x1p-37 * farthest);
  }
}

}  // namespace

void SensorBatch::clear() {
  sensors.clear();
  sweeps.clear();
  starts.clear();
  excluded.clear();
}

void SensorBatch::truncate(uint32_t count) {
  if (count < sensors.size()) excluded.resize(sensors[count].firstExcluded);
  sensors.resize(count);
  sweeps.resize(count);
  starts.resize(count);
}

Planned addSensor(SensorBatch& batch, const Query& query, uint32_t result, const Scene::Impl& scene,
                  const ObjectTree& tree, ObjectId object) {
  if (!tree.inRange()) return Planned::outOfRange;
  if (tree.nodes().empty()) return Planned::clear;
  const Motion motion = motionPast(query, scene, object);
  const Vector direction = scaledDirection(motion.direction);
  if (std::ilogb(largest(direction)) != 0) return Planned::outOfRange;
  const Mesh& mesh = scene.meshes[query.mesh];
  gpu::Sensor sensor{};
  sensor.placement = placementOf(mesh, query.worldFromMesh);
  Box box = boxOf(mesh, query.worldFromMesh.m);
  if (query.ignoreLeaving && query.slack) {
    sensor.placement.error = roundUp(sensor.placement.error + 2 * *query.slack);
    for (int k = 0; k < 3; ++k) {
      box.lo[k] -= 2 * *query.slack;
      box.hi[k] += 2 * *query.slack;
    }
  }
  if (!isInRange(sensor.placement)) return Planned::outOfRange;
  const Vector centre{box.middle(0), box.middle(1), box.middle(2)};
  const double farthest = farthestOf(tree.worldBox(), centre);
  const double size = std::max(double{sensor.placement.size}, kLeastShare * farthest);
  if (!(size >= 1 / kMostCoordinate && farthest <= 8 * kMostCoordinate)) return Planned::outOfRange;
  const double scale = std::ldexp(1.0, -std::ilogb(size));
  const double way = motion.wayUntil(motion.distance), distance = std::min(way * scale, kMostDistance);
  if (way > 0 && distance < kLeastDistance) return Planned::outOfRange;
  const double clearance = query.clearance;
  if (clearance > 0 && !(clearance * scale <= kMostClearance && clearance >= kLeastClearance * (size + farthest))) {
    return Planned::outOfRange;
  }
  for (int k = 0; k < 3; ++k) {
    box.lo[k] -= clearance;
    box.hi[k] += clearance;
  }

  const std::array<Vector, 3> axes = axesAlong(direction);
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 3; ++k) sensor.frame[4 * row + k] = static_cast<float>(axes[row][k]);
    sensor.direction[row] = static_cast<float>(axes[2][row]);
  }
  sensor.placement.mesh = query.mesh;
  sensor.scale = static_cast<float>(scale);
  sensor.unscale = static_cast<float>(1 / scale);
  // A contact that is certain wherever the slack moves a corner blocks. Twice the slack, since it may also tilt planes:
  // then the same holds for triangles in one plane (docs/exact.md, "Pairs that block"). By default the slack is at most
  // a sixteenth of either placement's error.
  if (query.ignoreLeaving && !query.slack) sensor.frame[7] = 0.125f;
  if (clearance > 0) {
    sensor.frame[3] = roundUp(clearance * scale);
    sensor.frame[11] = roundUp(cpu::toleranceOf(query, mesh) * scale);
  }
  sensor.distance = roundUp(distance);
  // A step's way has been rounded up.
  const float certain = motion.isStep ? roundDown((1 - 0x1p-48) * distance) : sensor.distance;
  sensor.stopBefore = query.anyHit ? std::min(certain, roundDown(distance)) : -1.0f;
  setBox(sensor, box, tree.anchor(), farthest + clearance);
  sensor.mask = query.mask;
  sensor.firstExcluded = static_cast<uint32_t>(batch.excluded.size());
  batch.excluded.insert(batch.excluded.end(), query.exclude.begin(), query.exclude.end());
  std::sort(batch.excluded.begin() + sensor.firstExcluded, batch.excluded.end());
  sensor.endExcluded = static_cast<uint32_t>(batch.excluded.size());

  gpu::Sweep sweep{};
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), sweep.pose);
  std::copy(direction.begin(), direction.end(), sweep.direction);
  sweep.directionLength = exact::length(direction);
  sweep.distance = motion.distance;
  sweep.perParameter = sweep.directionLength;
  if (motion.isStep) {
    sweep.perParameter = largest(direction) / largest(motion.direction);
    sweep.stepPerUnit = way > 0 ? roundDown((1 - 0x1p-20) / (way * scale)) : -1.0f;
    std::copy(motion.drift.begin(), motion.drift.end(), sweep.drift);
  }
  sweep.anyHit = query.anyHit ? 1 : 0;
  sweep.result = result;
  sweep.scale = sensor.scale;
  sweep.start = certain;
  sweep.hasClearance = clearance > 0 ? 1 : 0;
  if (query.ignoreLeaving) {
    sweep.ignoreLeaving = 1;
    sweep.isMirrored = exact::isMirroring(query.worldFromMesh) ? 1 : 0;
    sweep.slack = query.slack.value_or(-1);
    sweep.magnitude = placedMagnitude(mesh.farthest, query.worldFromMesh);
  }
  batch.sensors.push_back(sensor);
  batch.sweeps.push_back(sweep);
  batch.starts.push_back(object == kNone ? tree.nodes()[0].link : gpu::kLinkLeaf | object);
  return Planned::added;
}

}  // namespace radar
