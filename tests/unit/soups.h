// Random triangle soups for the tests of the exact search.
#pragma once

#include "support/world.h"
#include "workloads/random.h"
#include "workloads/shapes.h"

namespace soups {

using radar::tools::MeshData;
using radar::tools::Vec3;
using radar::tools::operator+;
using radar::tools::operator-;
using radar::tools::operator*;

/// With whole numbers of a range, chances, and poses of one scale.
class Random : public radar::tools::Random {
 public:
  using radar::tools::Random::Random;
  int integer(int lo, int hi) { return lo + static_cast<int>(below(static_cast<uint32_t>(hi - lo + 1))); }
  bool chance(double p) { return uniform(0, 1) < p; }
  /// Not very near to the middle.
  Vec3 inBall() {
    for (;;) {
      const Vec3 v = inCube(1);
      if (const double square = radar::tools::dot(v, v); square <= 1 && square > 1e-3) return v;
    }
  }
  radar::Transform pose(double scale, const Vec3& at) {
    return radar::tools::makePose(rotation(), {scale, scale, scale}, at);
  }
  /// Whole numbers from -most to most, not all 0.
  Vec3 latticeVector(int most) {
    Vec3 v{};
    while (v == Vec3{}) v = wholeVector(static_cast<uint32_t>(most));
    return v;
  }
};

inline void addTriangle(MeshData& mesh, const std::array<Vec3, 3>& corners) {
  for (const Vec3& corner : corners) {
    mesh.indices.push_back(mesh.vertexCount());
    addVertex(mesh, corner);
  }
}

/// Triangles of size about `size` in a ball of radius 1; some needles and some degenerate ones.
inline MeshData soup(Random& random, int triangles, double size, double odd) {
  MeshData mesh;
  for (int t = 0; t < triangles; ++t) {
    const Vec3 centre = random.inBall();
    std::array<Vec3, 3> c;
    for (Vec3& corner : c) corner = centre + size * random.inBall();
    if (random.chance(odd)) {
      const int kind = random.integer(0, 3);
      if (kind == 0) c[1] = c[0];                               // a segment
      if (kind == 1) c[2] = c[1] = c[0];                        // a point
      if (kind == 2) c[2] = c[0] + 1e-5 * (c[2] - c[0]);        // a needle
      if (kind == 3) c[2] = 0.5 * (c[0] + c[1]) + 1e-6 * c[2];  // a sliver
    }
    addTriangle(mesh, c);
  }
  return mesh;
}

/// With integer corners in [0, side].
inline std::array<Vec3, 3> latticeTriangle(Random& random, int side) {
  std::array<Vec3, 3> triangle;
  for (Vec3& corner : triangle) {
    for (double& c : corner) c = random.integer(0, side);
  }
  return triangle;
}

/// Lattice triangles: everything is degenerate, parallel, equal or touching.
inline MeshData lattice(Random& random, int triangles, int side) {
  MeshData mesh;
  for (int i = 0; i < triangles; ++i) addTriangle(mesh, latticeTriangle(random, side));
  return mesh;
}

}  // namespace soups
