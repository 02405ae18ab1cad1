// Cases in which bodies are at rest: they touch each other at the start, as drawn or up to the rounding of their poses.
// Each body has a frame of its own, which may mirror it. Some cases ask for a slack of 0, the others for the default.
#pragma once

#include "workloads/hard_cases.h"

namespace radar::tools {

// `how` the bodies are placed: 0 on a grid; 1 by quarter turns and whole steps; 2 turned and moved at random, so that
// poses round; 3 scaled and far away, too.

/// Solids that fit each other, of which one moves.
HardCase assemblyCase(double how, Random& random);
/// Equal boxes side by side and on top of each other.
HardCase stackedCase(double how, Random& random);
/// A body on tiles of a floor, against walls and edges, some of which lie in one plane.
HardCase cornerCase(double how, Random& random);
/// A peg in a hole of exactly its size, with three to eight sides.
HardCase pegCase(double how, Random& random);
/// One of the cases above, with some bodies moved by `depth`, so that they cross.
HardCase sunkCase(double depth, Random& random);

}  // namespace radar::tools
