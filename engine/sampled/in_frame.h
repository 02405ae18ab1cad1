// Meshes and boxes in a view's frame: whether floats can hold them, and how far off they are.
#pragma once

#include "scene/scene.h"

namespace radar {

/// Half an ulp of 1 in float.
inline constexpr double kFloatUnit = 0x1p-24;

/// Whether each row's terms, for vectors of the mesh's reach, but at least `least`, sum up to less than `most`.
bool staysBelow(const Vector& most, const Mesh& mesh, const Affine& m, double least);
/// Whether floats hold every entry of the matrix and every vertex that it places.
bool fitsFloats(const Mesh& mesh, const Affine& m);

/// Bound on the error of a vertex placed by a shader, world units (docs/method.md, "Placement in the pictures").
double placementError(const Mesh& mesh, const Affine& frameFromMesh);
/// Bound on the double-precision error of a vertex in a frame about `origin`, relative to `transformPoint`, world
/// units.
double doubleError(const Mesh& mesh, const Transform& pose, const Vector& origin);

/// A box around the mesh's vertices in the frame, tighter than that around the mesh's box, so that M fills the window.
Box tightBox(const Mesh& mesh, const Affine& frameFromMesh);
/// A box around a box that `m` has turned, whose points are then off by up to `error`. `centre`, `halfExtent`: arrays
/// of floats or doubles.
Box turned(const auto& centre, const auto& halfExtent, const Affine& m, double error) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    double middle = r[3], half = error;
    for (int k = 0; k < 3; ++k) {
      middle += r[k] * centre[k];
      half += std::abs(r[k]) * halfExtent[k];
    }
    box.lo[row] = middle - half;
    box.hi[row] = middle + half;
  }
  return box;
}
inline Box turned(const Box& box, const Affine& m, double error) {
  Vector centre, half;
  for (int k = 0; k < 3; ++k) {
    centre[k] = box.middle(k);
    half[k] = 0.5 * (box.hi[k] - box.lo[k]);
  }
  return turned(centre, half, m, error);
}

}  // namespace radar
