// A common point of two intersecting triangles.
#pragma once

#include "exact/contact.h"

namespace radar::exact {

/// The clearest crossing of an edge of one triangle with the other, in plain doubles, or one that exact arithmetic
/// finds if none is clear; of triangles in one plane, and of degenerate ones, any point that they share. For pictures
/// and messages only, no decision depends on it. It is on both triangles but for rounding of their coordinates. The
/// order of corners does not matter.
Vector commonPoint(const Triangle& a, const Triangle& b);

}  // namespace radar::exact
