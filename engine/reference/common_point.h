// A point that two intersecting triangles share.
#pragma once

#include "exact/contact.h"

namespace radar::reference {

/// Where an edge of the one best pierces the other, in plain doubles: for pictures and messages, nothing is decided by
/// it. NaN where no edge does (triangles in one plane, or degenerate).
exact::Vec commonPoint(const exact::Triangle& a, const exact::Triangle& b);

}  // namespace radar::reference
