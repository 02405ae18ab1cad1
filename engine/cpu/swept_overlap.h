// The filter in doubles before exact decisions: boxes, separating axes across the motion, times of contact.
#pragma once

#include "cpu/view.h"

namespace radar::cpu {

/// False if this pair certainly has no contact in [0, latest], in the view's unit; true is inconclusive.
bool mayMeet(const ViewedTriangle& a, const ViewedTriangle& b, double latest);

}  // namespace radar::cpu
