// A placed mesh as the device's search reads it.
#pragma once

#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

/// All members but `mask`, `root` and `mesh`. Where floats cannot hold the mesh or its pose (kMostCoordinate), perUnit
/// is 0.
gpu::Placement placementOf(const Mesh& mesh, const Pose& worldFromMesh);

/// Whether floats hold it.
inline bool isInRange(const gpu::Placement& placement) {
  return placement.perUnit > 0;
}

}  // namespace radar
