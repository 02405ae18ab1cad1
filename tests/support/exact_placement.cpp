#include "support/exact_placement.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "exact/dyadic.h"

namespace radar::test {

namespace {

using exact::Dyadic;
using Corner = std::array<float, 3>;

Dyadic magnitude(const Dyadic& x) {
  return x.sign() < 0 ? Dyadic(0.0) - x : x;
}

bool isAtMost(const Dyadic& x, double most) {
  return (Dyadic(most) - x).sign() >= 0;
}

double about(const Dyadic& x) {
  return quotient(x, Dyadic(1.0));
}

double share(const Dyadic& x, double most) {
  return most > 0 ? about(x) / most : 0;
}

// What the floats say of the normalised vertex on one axis.
Dyadic placedBy(const gpu::Placement& placement, int row, const Corner& q) {
  const float *coarse = &placement.coarse[4 * row], *fine = &placement.fine[4 * row];
  Dyadic sum = Dyadic(coarse[3]) + Dyadic(fine[3]);
  for (int k = 0; k < 3; ++k) sum = sum + (Dyadic(coarse[k]) + Dyadic(fine[k])) * Dyadic(q[k]);
  return sum;
}

// matrix * q, where the matrix is the pose's times the mesh's unit.
Dyadic turned(const Mesh& mesh, const Transform& pose, int row, const Corner& q) {
  Dyadic sum(0.0);
  for (int k = 0; k < 3; ++k) sum = sum + Dyadic(pose.m[4 * row + k]) * Dyadic(mesh.unit) * Dyadic(q[k]);
  return sum;
}

void checkVertices(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used) {
  for (const uint32_t vertex : mesh.indices) {
    const std::array<double, 3> truth = transformPoint(pose, &mesh.positions[3 * size_t{vertex}]);
    const Corner q{mesh.normalised(vertex, 0), mesh.normalised(vertex, 1), mesh.normalised(vertex, 2)};
    Dyadic sum(0.0);
    for (int row = 0; row < 3; ++row) {
      const Dyadic off = magnitude(placedBy(placement, row, q) - Dyadic(truth[row]));
      if (!isAtMost(off, placement.error)) {
        FAIL("vertex " << vertex << " is off by " << about(off) << ", not " << placement.error);
      }
      used.error = std::max(used.error, share(off, placement.error));
      sum = sum + magnitude(turned(mesh, pose, row, q));
      if (std::abs(q[row]) > placement.reach[row]) FAIL("vertex " << vertex << " is out of reach");
    }
    if (!isAtMost(sum, placement.size))
      FAIL("vertex " << vertex << " is at " << about(sum) << ", not " << placement.size);
  }
}

// What is farthest within reach is farthest off.
void checkInverse(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used) {
  for (int corner = 0; corner < 8; ++corner) {
    Corner q;
    for (int k = 0; k < 3; ++k) q[k] = (corner >> k & 1) != 0 ? placement.reach[k] : -placement.reach[k];
    for (int row = 0; row < 3; ++row) {
      const float* n = &placement.inverse[4 * row];
      Dyadic off = Dyadic(0.0) - Dyadic(q[row]);
      for (int k = 0; k < 3; ++k) off = off + Dyadic(n[k]) * turned(mesh, pose, k, q);
      off = magnitude(off);
      if (!isAtMost(off, n[3])) FAIL("row " << row << " is off by " << about(off) << ", not " << n[3]);
      used.inverse = std::max(used.inverse, share(off, n[3]));
    }
  }
}

}  // namespace

void checkPlacement(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used) {
  CHECK(placement.perUnit * mesh.unit == 1);
  for (int k = 0; k < 3; ++k) CHECK(double{placement.origin[k]} == mesh.origin[k]);
  checkVertices(mesh, pose, placement, used);
  checkInverse(mesh, pose, placement, used);
}

}  // namespace radar::test
