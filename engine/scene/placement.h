// A placed mesh for the device's search.
#pragma once

#include "scene/scene.h"
#include "shaders/shared/interop.h"

namespace radar {

/// Sets all members but `mask`, `root` and `mesh`. perUnit is 0 if floats cannot hold the mesh or its pose
/// (kMostCoordinate).
gpu::Placement placementOf(const Mesh& mesh, const Transform& worldFromMesh);

/// Whether floats can hold the mesh and its pose.
inline bool isInRange(const gpu::Placement& placement) {
  return placement.perUnit > 0;
}

}  // namespace radar
