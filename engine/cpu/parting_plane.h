// Planes between a hull and all that a triangle sweeps.
#pragma once

#include "cpu/part_contact.h"

namespace radar::cpu {

/// Adds planes, ever better ones, until the hull certainly does not meet the triangle until t = `latest`, or rounding
/// leaves no room between them. Corners are off by at most `error` each.
void addPartingPlanes(const HullMotion& motion, const exact::Triangle& corners, double error, double latest,
                      FreeTimes& free);

}  // namespace radar::cpu
