// Which pairs of triangles block a motion, and which cross at its start.
//
// Two triangles do not block if a plane keeps them apart, up to the slack, and the motion does not bring them closer
// along its normal n: n . (a - b) >= -slack for all corners a and b, direction . n >= 0, the largest component of n
// being 1 or -1. docs/exact.md proves that seventeen normals decide this.
#pragma once

#include "exact/contact.h"
#include "exact/translation.h"
#include "radar/scene.h"

namespace radar::exact {

/// How far surfaces at rest may sink into each other by rounding, world units, if a query gives no slack: the bound on
/// the error of n . (a - b) for poses rounded once. `greatest`: the greatest sum, over both shapes, of the absolute
/// values that a placed coordinate is summed from.
inline double defaultSlack(double greatest) {
  // A coordinate's three products and three sums lose at most 4u of that sum, and rounding the pose's entries u: 5u for
  // a corner, 10u for a difference, 30u = 15 * 2^-52 for the three terms of n . (a - b).
  return 16 * 0x1p-52 * greatest;
}

/// Whether the pose turns a mesh inside out.
bool isMirroring(const Transform& pose);

/// Whether corners in their order have a normal, (p1 - p0) x (p2 - p0), that points inwards, because the pose mirrors.
struct Mirrored {
  bool a = false, b = false;
};

/// How a triangle moves: by distance / length * direction. A direction of 0 is a motion that stands.
struct Way {
  Vector direction;
  double distance = 0, length = 1;
};

inline Way wayOf(const Translation& motion) {
  return {motion.stands ? Vector{} : motion.direction, motion.end, motion.length};
}

/// Whether triangle a, in motion, is blocked by b. Corners are as placed at the start, in the order of their meshes.
/// Triangles in the plane of either, up to the slack, that face each other and overlap by more than the slack are
/// pressed together: they block exactly if the motion would sink a into the solid behind b by more than the slack.
bool blocks(const Triangle& a, const Triangle& b, const Way& way, double slack, Mirrored mirrored);

/// Whether they block because they are pressed together. They then touch at the start, up to the slack, even if
/// rounding has let them pass each other.
bool arePressed(const Triangle& a, const Triangle& b, const Way& way, double slack, Mirrored mirrored);

/// Whether the triangles cross by more than the slack: no n has n . (a - b) >= -slack for all corners.
bool cross(const Triangle& a, const Triangle& b, double slack);

}  // namespace radar::exact
