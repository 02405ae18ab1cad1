#include "support/exact_placement.h"

#include <algorithm>
#include <cmath>

#include "exact/dyadic.h"
#include "support/catch.h"

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

double toDouble(const Dyadic& x) {
  return quotient(x, Dyadic(1.0));
}

double usedFraction(const Dyadic& x, double most) {
  return most > 0 ? toDouble(x) / most : 0;
}

// The coordinate at which the placement's floats put the normalised vertex q.
Dyadic placedBy(const gpu::Placement& placement, int row, const Corner& q) {
  const float *coarse = &placement.coarse[4 * row], *fine = &placement.fine[4 * row];
  Dyadic sum = Dyadic(coarse[3]) + Dyadic(fine[3]);
  for (int k = 0; k < 3; ++k) sum = sum + (Dyadic(coarse[k]) + Dyadic(fine[k])) * Dyadic(q[k]);
  return sum;
}

// A row of the pose's matrix times q in the units of the mesh's coordinates.
Dyadic linearPart(const Mesh& mesh, const Transform& pose, int row, const Corner& q) {
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
        FAIL("vertex " << vertex << " is off by " << toDouble(off) << ", more than " << placement.error);
      }
      used.error = std::max(used.error, usedFraction(off, placement.error));
      sum = sum + magnitude(linearPart(mesh, pose, row, q));
      if (std::abs(q[row]) > placement.reach[row]) FAIL("vertex " << vertex << " exceeds the reach");
    }
    if (!isAtMost(sum, placement.size))
      FAIL("vertex " << vertex << " is at " << toDouble(sum) << ", more than " << placement.size);
  }
}

// The error is largest at a corner of the reach.
void checkInverse(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used) {
  for (int corner = 0; corner < 8; ++corner) {
    Corner q;
    for (int k = 0; k < 3; ++k) q[k] = (corner >> k & 1) != 0 ? placement.reach[k] : -placement.reach[k];
    for (int row = 0; row < 3; ++row) {
      const float* n = &placement.inverse[4 * row];
      Dyadic off = Dyadic(0.0) - Dyadic(q[row]);
      for (int k = 0; k < 3; ++k) off = off + Dyadic(n[k]) * linearPart(mesh, pose, k, q);
      off = magnitude(off);
      if (!isAtMost(off, n[3])) FAIL("row " << row << " is off by " << toDouble(off) << ", more than " << n[3]);
      used.inverse = std::max(used.inverse, usedFraction(off, n[3]));
    }
  }
}

}  // namespace

tools::MeshData oddMesh(tools::Random& random, uint32_t number, double size) {
  const double extent = std::exp2(size + random.uniform(-3, 3)),
               baked = number % 2 == 0 ? 0 : extent * std::exp2(random.uniform(-4, 12));
  const std::array<double, 3> middle = random.inCube(baked);
  tools::MeshData mesh{.positions = {}, .indices = {0, 1, 2, 3, 4, 5}};
  for (size_t v = 0; v < 18; ++v) {
    const bool isFlat = (number % 5 == 3 && v % 3 == 2) || (number % 15 == 8 && v % 3 != 0) || number % 30 == 19;
    mesh.positions.push_back(static_cast<float>(middle[v % 3] + (isFlat ? 0 : random.uniform(-extent, extent))));
  }
  return mesh;
}

void checkPlacement(const Mesh& mesh, const Transform& pose, const gpu::Placement& placement, BoundsUsed& used) {
  CHECK(placement.perUnit * mesh.unit == 1);
  for (int k = 0; k < 3; ++k) CHECK(double{placement.origin[k]} == mesh.origin[k]);
  checkVertices(mesh, pose, placement, used);
  checkInverse(mesh, pose, placement, used);
}

}  // namespace radar::test
