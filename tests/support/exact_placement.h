// A placement's floats held against exact arithmetic.
#pragma once

#include "scene/placement.h"

namespace radar::test {

/// How much of its bounds a placement has used, at most.
struct BoundsUsed {
  double error = 0, inverse = 0;
};

/// Checks that the placement puts every vertex of the mesh where radar.h says that the pose puts it, but for
/// Placement::error; that none is farther away than Placement::size and Placement::reach say; and that the inverse's
/// rows give back whatever is within reach, but for what they say.
void checkPlacement(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used);

}  // namespace radar::test
