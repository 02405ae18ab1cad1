#include "sweep/contact_plan.h"

#include <algorithm>
#include <cmath>

#include "exact/contact.h"
#include "sweep/cluster_walk.h"

namespace radar {

namespace {

// What the mask costs, and for each triangle more, in triangles trimmed by the search: as measured on lavapipe
// (docs/method.md, "The mask").
constexpr uint64_t kMaskCost = 3000, kMaskTriangleCost = 4;
// Vertices that may be off by more than this, pixels, make a mask worthless; and float could not tell its pixels apart.
constexpr double kMostError = 1;
constexpr Box kEverywhere{{-INFINITY, -INFINITY, -INFINITY}, {INFINITY, INFINITY, INFINITY}};

// Appends the clusters of a placed mesh whose boxes meet `within`; returns the box around them.
Box collect(const Clusters& clusters, const Affine& frameFromMesh, double error, const Box& within, uint32_t placement,
            std::vector<gpu::ClusterRef>& out, uint64_t& triangles) {
  Box around;
  walkClusters(
      clusters, frameFromMesh, error, [&](const Box& box) { return overlap(box, within, 0); },
      [&](uint32_t node, const Box& box) {
        out.push_back({placement, node});
        triangles += clusters.nodes[node].count;
        around.merge(box);
      });
  return around;
}

// Of a mesh that float cannot place; its triangles are solved in double precision.
double errorOf(const Mesh& mesh, const Affine& frameFromMesh, double error) {
  return fitsFloats(mesh, frameFromMesh) ? error : INFINITY;
}

gpu::Placement placementOf(const Affine& frameFromMesh, double error, MeshId mesh, ObjectId object) {
  gpu::Placement p{};
  for (int i = 0; i < 12 && error < INFINITY; ++i) p.frameFromMesh[i] = static_cast<float>(frameFromMesh[i]);
  p.error = upward(error);
  p.mesh = mesh;
  p.object = object;
  p.moved = kNone;
  return p;
}

// Lays the mask's pixels over the sensor's window, with a quarter pixel to spare on each side for rounding.
void planMask(gpu::Target& target, const SensorWindow& window, double error, uint64_t cost) {
  const double side = std::max(window.box.hi[0] - window.box.lo[0], window.box.hi[1] - window.box.lo[1]);
  const double scale = (gpu::kMaskSide - 0.5) / side;
  if (!(error * scale < kMostError)) return;
  target.pixelsPerUnit = static_cast<float>(scale);
  for (int k = 0; k < 2; ++k) target.corner[k] = static_cast<float>(window.box.lo[k] - 0.25 / scale);
  target.maskCost = static_cast<uint32_t>(std::min<uint64_t>(cost, gpu::kNoMask - 1));
}

}  // namespace

ContactPlan planContact(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy) {
  ContactPlan plan;
  const Mesh& sensor = scene.meshes[query.mesh];
  const SensorWindow window = lookAlong(query, sensor);
  const Reach reach = reachOf(query, scene, hierarchy, window);
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), plan.target.pose);
  const Vector direction = scaledDirection(query.direction);
  std::copy(direction.begin(), direction.end(), plan.target.direction);
  plan.target.directionLength = exact::length(direction);
  plan.target.distance = query.distance;
  plan.target.mesh = query.mesh;
  plan.target.decides = query.decide ? 1 : 0;
  plan.target.enough = query.decide ? downward(query.distance) : 0;
  plan.target.maskCost = gpu::kNoMask;
  plan.hi = upward(query.distance);
  if (reach.objects.empty()) return plan;

  plan.axes = window.axes;
  plan.origin = window.origin;
  const double sensorError = errorOf(sensor, window.frameFromMesh, window.error);
  double worst = sensorError;
  plan.placements.push_back(placementOf(window.frameFromMesh, sensorError, query.mesh, kNone));
  Box around;
  uint64_t triangles = 0;
  for (const Reached& r : reach.objects) {
    const MeshId mesh = scene.objects[r.object].object.mesh;
    const auto placement = static_cast<uint32_t>(plan.placements.size());
    const size_t before = plan.scene.size();
    const double error = errorOf(scene.meshes[mesh], r.frameFromMesh, r.error);
    around.merge(collect(scene.meshes[mesh].clusters, r.frameFromMesh, error, r.loose ? kEverywhere : reach.prism.box,
                         placement, plan.scene, triangles));
    if (r.loose) around.merge(r.box);
    if (plan.scene.size() != before) plan.placements.push_back(placementOf(r.frameFromMesh, error, mesh, r.object));
    worst = std::max(worst, error);
  }
  if (plan.scene.empty()) return plan;
  // Only what of the sensor passes over something counts: its box, swept forward, meets theirs.
  Box behind = around;
  behind.lo[2] = -1e300;
  collect(sensor.clusters, window.frameFromMesh, sensorError, sensor.deforms ? kEverywhere : behind, 0, plan.sensor,
          triangles);
  if (plan.sensor.empty()) plan.scene.clear();
  planMask(plan.target, window, worst, kMaskCost + kMaskTriangleCost * triangles);
  return plan;
}

}  // namespace radar
