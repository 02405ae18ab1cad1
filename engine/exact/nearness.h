// How near a triangle comes to another on its way: which pairs block a motion with a clearance.
#pragma once

#include "exact/blocking.h"

namespace radar::exact {

/// Whether triangle a, in motion, is blocked by b at a distance. Let s be their distance at the start and m the lesser
/// of s and `clearance`. They block if at some time from the start on, also beyond the end, they are nearer than m -
/// slack; if m is at most the slack, they block as blocks() says. In real arithmetic, but that lengths below 2^-400 of
/// the greatest one count as 0.
bool blocksWithin(const Triangle& a, const Triangle& b, const Way& way, double clearance, double slack,
                  Mirrored mirrored);

}  // namespace radar::exact
