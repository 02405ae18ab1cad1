// A mesh placed in the world, as the tests of its tree's boxes need it.
#pragma once

#include "cpu/motion.h"
#include "scene/scene.h"

namespace radar::cpu {

using Matrix = std::array<Vector, 3>;  ///< rows

/// Places normalised vertices: world = origin + linear * q. The bounds are derived in docs/method.md.
struct Placement {
  Vector origin;
  Matrix linear;
  Vector extent;  ///< per world axis: bound on |linear * q|
  Vector error;   ///< per world axis: how far `radar::place` and the formula above may be apart

  Placement(const Mesh& mesh, const Pose& worldFromMesh);
};

/// Covectors along a mesh's normalised axes. Any would do: they are the rows of the inverse as far as rounding goes,
/// and `residual` says how far that is.
struct MeshAxes {
  Matrix rows;
  Vector residual;  ///< of row k: the sum over columns j of |rows[k] . linear[.][j] - (j == k)|, as computed

  explicit MeshAxes(const Matrix& linear);
};

}  // namespace radar::cpu
