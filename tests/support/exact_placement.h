// Checks a placement's floats with exact arithmetic.
#pragma once

#include "scene/placement.h"
#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::test {

/// The largest fraction of its error bounds that a placement has used.
struct BoundsUsed {
  double error = 0, inverse = 0;
};

/// Six vertices near the mesh's origin or far from it; flat, a line or a point, too. `size`: an exponent.
tools::MeshData oddMesh(tools::Random& random, uint32_t number, double size);

/// Checks that the placement puts every vertex of the mesh where the pose puts it, within Placement::error; that no
/// vertex exceeds Placement::size or Placement::reach; and that the inverse recovers every point within the reach,
/// within the errors in its rows.
void checkPlacement(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used);

}  // namespace radar::test
