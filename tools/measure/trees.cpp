#include "measure/trees.h"

#include <algorithm>
#include <cmath>

#include "measure/clock.h"
#include "scene/scene.h"
#include "workloads/generate.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace radar::tools {

namespace {

template <class Vector>
double bytesOf(const Vector& vector) {
  return static_cast<double>(vector.capacity() * sizeof(vector[0]));
}

double bytesOfMesh(const Mesh& mesh) {
  const MeshTree& tree = mesh.tree;
  return bytesOf(mesh.positions) + bytesOf(mesh.indices) + 3 * bytesOf(mesh.local[0]) + bytesOf(tree.nodes) +
         bytesOf(tree.order) + bytesOf(tree.corners) + bytesOf(tree.below);
}

TreeCost ourTree(const MeshData& mesh, std::span<const float> moved, std::span<const Transform> places) {
  Scene scene;
  TreeCost cost;
  MeshId id = kNone;
  const double build = lapOf([&] { id = scene.addMesh(mesh.positions, mesh.indices); }).wall;
  if (places.empty()) {
    cost.build = build;
    cost.bytes = bytesOfMesh(scene.impl().meshes[id]);
    cost.refit = lapOf([&] { scene.setPositions(id, moved); }).wall;
    return cost;
  }
  std::vector<ObjectId> objects;
  cost.build = lapOf([&] {
                 for (const Transform& place : places) {
                   objects.push_back(scene.addObject({.mesh = id, .worldFromMesh = place}));
                 }
                 scene.impl().objectTree();
               }).wall;
  cost.bytes = bytesOf(scene.impl().objects) + bytesOf(scene.impl().changedAt) +
               bytesOf(scene.impl().objectTree().nodes()) + 2.0 * sizeof(uint32_t) * static_cast<double>(places.size());
  cost.refit = lapOf([&] {
                 scene.setTransforms(objects, places);
                 scene.impl().objectTree();
               }).wall;
  return cost;
}

void keepLeast(TreeCost& least, const TreeCost& next, bool isFirst) {
  least = isFirst ? next : TreeCost{std::min(least.build, next.build), std::min(least.refit, next.refit), next.bytes};
}

void addRow(Json& report, const std::string& over, size_t count, MeasureTree* other, const MeshData& mesh,
            std::span<const float> moved, std::span<const Transform> places) {
  TreeCost ours;
  std::optional<TreeCost> others;
  const size_t passes = std::clamp<size_t>(5'000'000 / count, 1, 15);
  for (size_t pass = 0; pass < passes; ++pass) {
    keepLeast(ours, ourTree(mesh, moved, places), pass == 0);
    if (const auto next = other(mesh, moved, places))
      keepLeast(others.emplace(others.value_or(*next)), *next, pass == 0);
  }
  Json row{{"over", over},
           {"build_ms", 1e3 * ours.build},
           {"refit_ms", 1e3 * ours.refit},
           {"bytes_each", ours.bytes / static_cast<double>(count)}};
  const TreeCost theirs = others.value_or(TreeCost{NAN, NAN, NAN});
  row["embree_build_ms"] = 1e3 * theirs.build;
  row["embree_refit_ms"] = 1e3 * theirs.refit;
  row["embree_bytes_each"] = theirs.bytes / static_cast<double>(count);
  row["times_embree_build"] = ours.build / theirs.build;
  row["times_embree_refit"] = ours.refit / theirs.refit;
  partOf(report, "trees", "Section trees, all cores")["rows"].push_back(row);
}

}  // namespace

void measureTrees(Extent extent, MeasureTree* other, Json& report) {
  const std::vector<uint32_t> full{100'000, 1'000'000, 10'000'000}, few{1'000};
  for (const uint32_t triangles : extent == Extent::full ? full : few) {
    const auto rings = static_cast<uint32_t>(std::lround(std::sqrt(triangles / 2.0)));
    const MeshData sphere = makeUvSphere(rings + 1, rings);
    std::vector<float> moved = sphere.positions;
    for (size_t i = 0; i < moved.size(); i += 3) {
      const auto wave = static_cast<float>(1 + 0.05 * std::sin(9.0 * moved[i] + 7.0 * moved[i + 1]));
      for (size_t k = i; k < i + 3; ++k) moved[k] *= wave;
    }
    addRow(report, std::to_string(triangles) + " triangles", sphere.triangleCount(), other, sphere, moved, {});
  }
  const uint32_t boxes = extent == Extent::full ? 1'000'000 : 1'000;
  Random random(1);
  std::vector<Transform> places(boxes);
  for (Transform& place : places) place = placedAt(random.inCube(4 * std::cbrt(static_cast<double>(boxes))));
  addRow(report, std::to_string(boxes) + " objects", boxes, other, makeBox({1, 1, 1}), {}, places);
  partOf(report, "trees")["state"] = "done";
}

}  // namespace radar::tools
