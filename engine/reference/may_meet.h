// The filter in doubles that stands before exact decisions: boxes, separating axes across the motion, times of contact.
#pragma once

#include "reference/placed.h"

namespace radar::reference {

/// False if this pair certainly gives no contact in [0, latest]. True means "look closer".
bool mayMeet(const PlacedTriangle& a, const PlacedTriangle& b, double latest);

}  // namespace radar::reference
