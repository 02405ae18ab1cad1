// The filter in doubles before exact decisions: boxes, separating axes across the motion, times of contact.
#pragma once

#include "cpu/view.h"

namespace radar::cpu {

/// What doubles know of a pair's contact in [0, latest], in the view's unit: there is none, or none at the start, or
/// nothing.
enum class Meeting { never, ahead, unknown };
Meeting meetingOf(const ViewedTriangle& a, const ViewedTriangle& b, double latest);

}  // namespace radar::cpu
