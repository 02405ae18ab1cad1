// Vertices of a file, in doubles, as the floats of a mesh.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "radar/scene.h"

namespace radar::tools {

/// Vertex i is at base + positions[3 i ...].
struct FloatVertices {
  std::vector<float> positions;
  std::array<double, 3> base{};
  double change = 0;      ///< the farthest that a triangle's vertex is moved along an axis
  bool isSpoilt = false;  ///< most triangles are changed by more than 2^-12 of their longest side
};

/// Floats about the origin, unless these would move a vertex by more than 2^-20 of the mesh's size, or spoil the mesh;
/// then about a base near its middle, if that is better. `positions`, finite, are in the range of floats.
FloatVertices floatVertices(std::span<const double> positions, std::span<const uint32_t> indices);

/// The pose of a mesh about its base: worldFromFile * base, rounded once; worldFromFile itself without a base.
Transform aboutBase(const Transform& worldFromFile, const std::array<double, 3>& base);

}  // namespace radar::tools
