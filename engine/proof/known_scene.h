// A scene and queries whose answers the CPU knows, by which a device proves itself: an optimiser of its driver, or
// shaders from a stale cache, may compute wrongly what the checks of its arithmetic (gpu/arithmetic.h) find right.
#pragma once

#include <vector>

#include "radar/query.h"

namespace radar {

/// Boxes on a lattice, jagged bodies, needles and sheets, turned and sheared, whose meshes have origins of their own:
/// near the origin if `seed` is even, else 65,536 units from it. The poses of objects are floats.
struct KnownScene {
  explicit KnownScene(uint64_t seed);
  Scene scene;
  std::vector<MeshId> meshes;
  std::vector<Query> queries;
};

}  // namespace radar
