#include "workloads/arm.h"

#include <cmath>

#include "workloads/random.h"
#include "workloads/shapes.h"
#include "workloads/vectors.h"

namespace radar::tools {

namespace {

// Metres.
constexpr std::array kLengths{0.15, 0.4, 0.35, 0.1, 0.1, 0.1};
constexpr double kThickness = 0.1, kGap = 0.02;
constexpr std::array<Vec3, 6> kAxes{{{0, 0, 1}, {0, 1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 1, 0}, {0, 0, 1}}};
constexpr uint32_t kParts = 31, kShelves = 20;

/// A rounded body along z.
MeshData makeLink(double length, uint32_t detail) {
  MeshData mesh = makeTorus(kThickness / 2, 0.45 * kThickness, detail / 2, detail * 2 / 5);
  for (size_t i = 2; i < mesh.positions.size(); i += 3) {
    mesh.positions[i] *= static_cast<float>(length / 2 / (0.45 * kThickness));
  }
  return mesh;
}

}  // namespace

ArmCell makeArmCell(const ArmOptions& options) {
  Random random(options.seed);
  ArmCell cell;
  Workload& workload = cell.workload;
  double height = 0.05;
  for (uint32_t i = 0; i < kLengths.size(); ++i) {
    workload.meshes.push_back(named("link", makeLink(kLengths[i], options.detail)));
    cell.chain.links.push_back({.parent = i == 0 ? kNone : i - 1,
                                .parentFromJoint = placedAt({0, 0, height}),
                                .joint = JointType::revolute,
                                .axis = kAxes[i],
                                .variable = i,
                                .meshes = {{i, placedAt({0, 0, kLengths[i] / 2})}}});
    height = kLengths[i] + kGap;
    for (uint32_t other = 0; other + 1 < i; ++other) cell.chain.pairs.push_back({other, i});
  }
  cell.chain.variables = static_cast<uint32_t>(kLengths.size());
  workload.meshes.push_back(named("part", makeTorus(0.12, 0.04, options.detail, options.detail * 16 / 25)));
  workload.meshes.push_back(named("shelf", makeBox({0.02, 0.6, 0.4})));
  SceneSpec scene;
  for (uint32_t i = 0; i < kParts; ++i) {
    const Vec3 from = random.direction();
    const double far = random.uniform(0.75, 1.2);
    scene.instances.push_back(
        {6, makePose(random.rotation(), {1, 1, 1}, {far * from[0], far * from[1], 0.1 + far * std::abs(from[2])})});
  }
  for (uint32_t i = 0; i < kShelves; ++i) {
    const Vec3 from = random.direction();
    const double far = 1 / std::hypot(from[0], from[1]);
    scene.instances.push_back(
        {7, makePose(random.rotation(), {1, 1, 1}, {far * from[0], far * from[1], random.uniform(0.2, 0.9)})});
  }
  workload.scenes.push_back(std::move(scene));
  for (uint32_t i = 0; i < options.motions; ++i) {
    std::array<double, 12> motion;
    for (size_t k = 0; k < 6; ++k) {
      // Upright enough to be free of the ground half the time.
      motion[k] = random.uniform(-2.5, 2.5) * (k == 1 || k == 2 ? 0.5 : 1);
      motion[6 + k] = motion[k] + options.turn * random.uniform(-1, 1);
    }
    cell.motions.push_back(motion);
  }
  return cell;
}

}  // namespace radar::tools
