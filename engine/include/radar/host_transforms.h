// How transforms of floats lie in a host's memory.
#pragma once

#include <cstddef>
#include <variant>

#include "radar/scene.h"

namespace radar {

/// A matrix: its entry in row i and column k is `i * row + k * column` bytes from its beginning; column 3 is the
/// position. The last row of a 4x4 matrix is not read.
struct MatrixLayout {
  uint32_t row = 16;
  uint32_t column = 4;
};
inline constexpr MatrixLayout kRowMajor{16, 4};     ///< VkTransformMatrixKHR, or a 4x4 matrix by rows
inline constexpr MatrixLayout kColumnMajor{4, 16};  ///< a 4x4 matrix by columns, such as GLSL's mat4

/// A position, a unit quaternion and scales; bytes from the transform's beginning.
struct QuaternionLayout {
  uint32_t position = 0;     ///< of 3 floats
  uint32_t quaternion = 12;  ///< of 4 floats x, y, z, w: w is the cosine of half the angle
  uint32_t scale = 28;       ///< of the scales
  uint32_t scales = 3;       ///< 3: along the mesh's axes, before turning; 1: the same along all; 0: none
};

using TransformLayout = std::variant<MatrixLayout, QuaternionLayout>;

/// Reads a transform. Its numbers are floats, and the engine's shaders compute the same ones on every device. From a
/// quaternion and scales s they are, with every sum, difference and product rounded to the nearest float, ties to even:
///
///     X = x + x, Y = y + y, Z = z + z
///
///     (1 - (yY + zZ)) s0     (xY - wZ) s1        (xZ + wY) s2
///        (xY + wZ) s0     (1 - (xX + zZ)) s1     (yZ - wX) s2
///        (xZ - wY) s0        (yZ + wX) s1     (1 - (xX + yY)) s2
///
/// The quaternion is not normalised.
RADAR_API Transform readTransform(const std::byte* bytes, const TransformLayout& layout);

}  // namespace radar
