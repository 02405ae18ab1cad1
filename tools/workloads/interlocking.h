// Shapes of many long thin triangles, inside each other and turned off the axes. The boxes of their parts overlap from
// the start, which is the hardest case for a search by boxes.
#pragma once

#include <array>

#include "workloads/workload.h"

namespace radar::tools {

enum class Interlocking {
  ringOnPeg,   ///< a fine ring on a peg of long thin triangles, with room around it
  combInComb,  ///< two combs, the teeth of each in the gaps of the other
  crossing     ///< two gratings of long thin triangles, one over the other, that cross
};
inline constexpr std::array kInterlocking{Interlocking::ringOnPeg, Interlocking::combInComb, Interlocking::crossing};
const char* nameOf(Interlocking kind);

/// One scene of as many pairs as sensors, far from each other, and one batch: the
/// first shape of each pair is the sensor. It moves as far as the shapes are long, mostly where it is free to move.
struct InterlockingPairs {
  Interlocking kind = Interlocking::ringOnPeg;
  uint32_t sensors = 16;
  uint64_t seed = 23;
};
Workload makeWorkload(const InterlockingPairs& options);

}  // namespace radar::tools
