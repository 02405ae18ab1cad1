// A point that two intersecting triangles share.
#pragma once

#include "exact/contact.h"

namespace radar::exact {

/// Where an edge of the one best pierces the other, in plain doubles: for pictures and messages, nothing is decided by
/// it, and the order of corners does not matter. NaN where no edge does (triangles in one plane, or degenerate).
Vector commonPoint(const Triangle& a, const Triangle& b);

}  // namespace radar::exact
