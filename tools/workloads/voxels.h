// Closed solids of unit cubes on a grid, which fit each other exactly.
#pragma once

#include <set>
#include <vector>

#include "workloads/random.h"
#include "workloads/workload.h"

namespace radar::tools {

using Voxel = std::array<int, 3>;  ///< the cube from this corner to the one a step further along each axis
using Solid = std::set<Voxel>;

/// The boundary of a solid, wound outwards, each square cut along a random diagonal.
MeshData boundaryOf(const Solid& solid, Random& random);

/// Disjoint solids that fill part of a grid of `side` cells along each axis; `count` of them at most, at least one.
std::vector<Solid> packedSolids(uint32_t side, uint32_t count, Random& random);

/// The six rods of a burr puzzle, 2 x 2 x 6 cells each, in pairs along the axes. Each lacks what the rods before it
/// have, so that they come apart in their order.
std::vector<Solid> burrPieces();

}  // namespace radar::tools
