// A mesh placed in the world, for the box tests of its tree.
#pragma once

#include "exact/motion.h"
#include "scene/scene.h"

namespace radar::cpu {

using Matrix3 = std::array<Vector, 3>;  ///< rows

/// Places normalised vertices: world = origin + linear * q. docs/method.md derives the bounds.
struct MeshPlacement {
  Vector origin;
  Matrix3 linear;
  Vector extent;  ///< per world axis: bound on |linear * q|
  Vector error;   ///< per world axis: bound on the difference between `transformPoint` and the formula above

  MeshPlacement(const Mesh& mesh, const Transform& worldFromMesh);
};

/// Covectors along a mesh's normalised axes: the rows of the inverse, except for rounding, which `residual` bounds. Any
/// covectors would be valid.
struct MeshAxes {
  Matrix3 rows;
  Vector residual;  ///< per row k: the sum over columns j of |rows[k] . linear[.][j] - (j == k)|, as computed

  explicit MeshAxes(const Matrix3& linear);
};

}  // namespace radar::cpu
