// Where two triangles touch.
#pragma once

#include "math/frame.h"

namespace radar {

using Corners = std::array<Vector, 3>;

/// Corners of an edge of a triangle, by the edge's number.
inline constexpr int kEdgeFrom[] = {0, 1, 0}, kEdgeTo[] = {1, 2, 2};

/// Sets the result's point and normal, given its t: those of `feature` (shaders/interop.h, "Features") of the sensor's
/// triangle at the start and the scene's.
void describe(Result& result, uint32_t feature, const Corners& sensor, const Corners& scene, const Vector& direction);

}  // namespace radar
