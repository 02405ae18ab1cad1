// Point and normal of a contact of two triangles.
#pragma once

#include "math/frame.h"
#include "radar/answers.h"

namespace radar {

using Corners = std::array<Vector, 3>;

/// End corners of each edge of a triangle.
inline constexpr int kEdgeFrom[] = {0, 1, 0}, kEdgeTo[] = {1, 2, 2};

/// Sets the result's features, point and normal, given its t and the `feature` that touches (shaders/shared/interop.h,
/// "Features"). `sensor`: the triangle at the start.
void describe(Result& result, uint32_t feature, const Corners& sensor, const Corners& scene, const Vector& direction);

}  // namespace radar
