// Changes of a case that keep its first contact to the bit, since every coordinate stays exact in float.
#pragma once

#include "workloads/hard_cases.h"

namespace radar::tools {

/// Two shapes of any kind whose coordinates, placed and moved along, are whole multiples of 2^-8 and small; directions
/// have whole components and a whole length.
HardCase dyadicCase(Random& random);

/// Turns everything by quarter turns and moves it, in the poses or in the vertices.
HardCase movedTogether(const HardCase& hard, Random& random);
/// The object moves towards the sensor instead.
HardCase changedPlaces(const HardCase& hard);
/// Cuts random triangles from a corner to the middle of the opposite edge.
HardCase cutInTwo(const HardCase& hard, Random& random);
/// Adds objects that the sensor cannot reach.
HardCase withFarObjects(const HardCase& hard, Random& random);
/// Sweeps the first part of the way, then the rest from there.
std::array<HardCase, 2> splitWay(const HardCase& hard, Random& random);

}  // namespace radar::tools
