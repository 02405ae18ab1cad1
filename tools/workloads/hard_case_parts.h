// The parts that the makers of hard cases (hard_families.cpp) share.
#pragma once

#include "workloads/hard_cases.h"

namespace radar::tools {

Transform at(const Vec3& where);
/// 10 to 10^7 units from the origin, in any direction.
Vec3 farOrigin(Random& random);

/// About x, by the angle of that tangent.
Rotation tilt(double tangent);
/// About z.
Rotation roll(Random& random);
/// Turned; sometimes stretched, sheared and mirrored, too.
Transform anyPose(Random& random, const Vec3& where);

MeshData resized(MeshData mesh, double factor);
/// Something solid, about 1 wide, in any pose around `middle`.
PlacedMesh compact(Random& random, const Vec3& middle);

/// A D that a contact after about `gap` may lie beyond.
double reachFor(double gap, Random& random);

using MakeShape = MeshData (*)(Random&);
/// The sensor below the object, which is in the way more often than not.
HardCase pairOf(MakeShape sensor, MakeShape object, Random& random);
/// The same of shapes of every kind.
HardCase anyPair(Random& random);
/// Blocks that touch sideways along as many of x and y as `grazing` says, `gap` apart along z; D is three more.
HardCase blocks(uint32_t grazing, double gap, Random& random);

}  // namespace radar::tools
