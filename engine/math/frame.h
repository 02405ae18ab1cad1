// The frame in which a sensor looks along its motion.
#pragma once

#include "math/vector.h"
#include "radar/radar.h"

namespace radar {

/// Orthonormal axes: [2] along `direction` (finite, not zero), [0] and [1] across. A direction along a world axis gives
/// world axes, exactly.
std::array<Vector, 3> axesAlong(const Vector& direction);

/// `direction` times a power of two that makes its largest component 1 to 2: the same motion, far from underflow. As it
/// is, where components are too different in size for that to be exact.
Vector scaledDirection(const Vector& direction);

/// Length of `v`, without overflow or underflow on the way.
double lengthOf(const Vector& v);

/// frameFromMesh for a mesh whose vertices are given relative to `centre`: axes * (pose(centre + q) - origin), with the
/// difference taken in the world, before turning.
Affine frameFromLocal(const std::array<Vector, 3>& axes, const Vector& origin, const Pose& worldFromMesh,
                      const Vector& centre);

/// worldFromMesh applied to a double-precision point.
Vector transform(const Pose& worldFromMesh, const Vector& p);

}  // namespace radar
