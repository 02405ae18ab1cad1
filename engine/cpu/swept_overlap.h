// The filter in doubles that stands before exact decisions: boxes, separating axes across the motion, times of contact.
#pragma once

#include "cpu/view.h"

namespace radar::cpu {

/// False if this pair certainly gives no contact in [0, latest], in the view's unit. True means "look closer".
bool mayMeet(const ViewedTriangle& a, const ViewedTriangle& b, double latest);

}  // namespace radar::cpu
