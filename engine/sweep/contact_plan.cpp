#include "sweep/contact_plan.h"

#include <algorithm>
#include <cmath>

#include "sweep/cluster_walk.h"

namespace radar {

namespace {

// Appends the clusters of a placed mesh whose boxes meet `within`; returns the box around them.
Box collect(const Clusters& clusters, const Affine& frameFromMesh, double error, const Box& within, uint32_t placement,
            std::vector<gpu::ClusterRef>& out) {
  Box around;
  walkClusters(
      clusters, frameFromMesh, error, [&](const Box& box) { return overlap(box, within, 0); },
      [&](uint32_t node, const Box& box) {
        out.push_back({placement, node});
        around.merge(box);
      });
  return around;
}

gpu::Placement placementOf(const Affine& frameFromMesh, double error, MeshId mesh, ObjectId object) {
  gpu::Placement p{};
  for (int i = 0; i < 12; ++i) p.frameFromMesh[i] = static_cast<float>(frameFromMesh[i]);
  p.error = upward(error);
  p.mesh = mesh;
  p.object = object;
  return p;
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
  plan.target.directionLength = lengthOf(direction);
  plan.target.distance = query.distance;
  plan.target.mesh = query.mesh;
  plan.target.enough = query.decide ? downward(query.distance) : 0;
  if (reach.objects.empty()) return plan;

  plan.placements.push_back(placementOf(window.frameFromMesh, window.error, query.mesh, kNone));
  Box around;
  for (const Reached& r : reach.objects) {
    const MeshId mesh = scene.objects[r.object].object.mesh;
    const auto placement = static_cast<uint32_t>(plan.placements.size());
    const size_t before = plan.scene.size();
    around.merge(
        collect(scene.meshes[mesh].clusters, r.frameFromMesh, r.error, reach.prism.box, placement, plan.scene));
    if (plan.scene.size() != before) plan.placements.push_back(placementOf(r.frameFromMesh, r.error, mesh, r.object));
  }
  if (plan.scene.empty()) return plan;
  // Only what of the sensor passes over something counts: its box, swept forward, meets theirs.
  Box behind = around;
  behind.lo[2] = -1e300;
  collect(sensor.clusters, window.frameFromMesh, window.error, behind, 0, plan.sensor);
  if (plan.sensor.empty()) plan.scene.clear();
  return plan;
}

}  // namespace radar
