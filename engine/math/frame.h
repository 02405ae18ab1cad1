// Frames along a sensor's motion.
#pragma once

#include "math/vector.h"
#include "radar/scene.h"

namespace radar {

/// Orthonormal axes: [2] along `direction` (finite, not zero), [0] and [1] across. A direction along a world axis gives
/// world axes, exactly.
std::array<Vector, 3> axesAlong(const Vector& direction);
/// The same along a direction of length 1, to a few roundings.
std::array<Vector, 3> axesAlongUnit(const Vector& forward);

/// `v`, which is not zero, at length 1; without intermediate overflow or underflow.
Vector normalized(Vector v);

/// `direction`, scaled by a power of two so that its largest component is 1 to 2: the same motion, far from underflow.
/// If the components differ too much in size for that to be exact, it is scaled only so that its length does not
/// overflow; unchanged if even that is not exact.
Vector scaledDirection(const Vector& direction);

/// Length of `v`, without intermediate overflow or underflow.
double lengthOf(const Vector& v);

/// The transform from a mesh's vertices, relative to `centre`, to a frame: axes * (pose(centre + q) - origin). The
/// difference is taken in the world, before the rotation.
Affine frameFromLocal(const std::array<Vector, 3>& axes, const Vector& origin, const Transform& worldFromMesh,
                      const Vector& centre);

/// worldFromMesh applied to a double-precision point.
Vector transform(const Transform& worldFromMesh, const Vector& p);

}  // namespace radar
