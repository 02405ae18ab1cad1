// Changes of a case that leave its first contact where it is, to the bit: every coordinate stays exact in float.
#pragma once

#include "workloads/stability_cases.h"

namespace radar::tools {

/// Two shapes of any kind whose coordinates, placed and moved along, are whole multiples of 2^-8 and small; directions
/// have whole components and a whole length.
StabilityCase dyadicCase(Random& random);

/// Everything turned by quarter turns and moved, by the poses or in the vertices.
StabilityCase movedTogether(const StabilityCase& made, Random& random);
/// The object moves towards the sensor instead.
StabilityCase changedPlaces(const StabilityCase& made);
/// Triangles cut from a corner to the middle of the opposite edge, at random.
StabilityCase cutInTwo(const StabilityCase& made, Random& random);
/// Objects added that the sensor cannot reach.
StabilityCase withFarObjects(const StabilityCase& made, Random& random);
/// The first part of the way, and the rest from where that ends.
std::array<StabilityCase, 2> splitWay(const StabilityCase& made, Random& random);

}  // namespace radar::tools
