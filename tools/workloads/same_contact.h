// Changes of a case that leave its first contact where it is, to the bit: every coordinate stays exact in float.
#pragma once

#include "workloads/hard_cases.h"

namespace radar::tools {

/// Two shapes of any kind whose coordinates, placed and moved along, are whole multiples of 2^-8 and small; directions
/// have whole components and a whole length.
HardCase dyadicCase(Random& random);

/// Everything turned by quarter turns and moved, by the poses or in the vertices.
HardCase movedTogether(const HardCase& hard, Random& random);
/// The object moves towards the sensor instead.
HardCase changedPlaces(const HardCase& hard);
/// Triangles cut from a corner to the middle of the opposite edge, at random.
HardCase cutInTwo(const HardCase& hard, Random& random);
/// Objects added that the sensor cannot reach.
HardCase withFarObjects(const HardCase& hard, Random& random);
/// The first part of the way, and the rest from where that ends.
std::array<HardCase, 2> splitWay(const HardCase& hard, Random& random);

}  // namespace radar::tools
