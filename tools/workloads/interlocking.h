// Shapes of many long thin triangles inside each other, turned off the axes, so that the boxes of their parts
// overlap from the start: what a search by boxes finds hardest.
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

/// One scene of as many pairs as sensors, far from each other, and one batch: of each pair the first is the sensor and
/// moves as far as the shapes are long, mostly the way it is free to move. Pair k is k of `kind`.
struct InterlockingPairs {
  Interlocking kind = Interlocking::ringOnPeg;
  uint32_t sensors = 16;
  uint64_t seed = 23;
};
Workload makeWorkload(const InterlockingPairs& options);

}  // namespace radar::tools
