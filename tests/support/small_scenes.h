// What small scenes are made of.
#pragma once

#include "support/world.h"
#include "workloads/shapes.h"

namespace radar::test {

inline MeshId addMesh(Scene& scene, const tools::MeshData& mesh, const std::optional<Bounds>& bounds = {}) {
  return scene.addMesh(mesh.positions, mesh.indices, bounds);
}
/// A box around the origin.
inline MeshId addBox(Scene& scene, double edge = 1) {
  return addMesh(scene, tools::makeBox({edge, edge, edge}));
}
/// One at that height across z.
inline tools::MeshData triangle(float z = 0) {
  return {.positions = {-1, -1, z, 1, -1, z, 0, 1, z}, .indices = {0, 1, 2}};
}

}  // namespace radar::test
