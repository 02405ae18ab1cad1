// Checks a placement's floats with exact arithmetic.
#pragma once

#include "scene/placement.h"

namespace radar::test {

/// The largest fraction of its error bounds that a placement has used.
struct BoundsUsed {
  double error = 0, inverse = 0;
};

/// Checks that the placement puts every vertex of the mesh where the pose puts it, within Placement::error; that no
/// vertex exceeds Placement::size or Placement::reach; and that the inverse recovers every point within the reach,
/// within the errors in its rows.
void checkPlacement(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used);

}  // namespace radar::test
