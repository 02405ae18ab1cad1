// Where a pose puts a mesh.
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/float_environment.h"
#include "scene/scene.h"

namespace radar {

namespace {

Vector placed(const Transform& pose, const float* p) {
  const double x = p[0], y = p[1], z = p[2];
  Vector out;
  for (int k = 0; k < 3; ++k) {
    const double* r = &pose.m[4 * k];
    out[k] = ((r[0] * x + r[1] * y) + r[2] * z) + r[3];
  }
  return out;
}

struct Interval {
  double lo, hi;
};

// Of a cutter.
Box boxOfCutter(std::span<const RingHull> parts, const std::array<double, 12>& m) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    const Vector n{r[0], r[1], r[2]};
    for (const RingHull& part : parts) {
      const double room = 0x1p-47 * (std::abs(r[3]) + norm1(n) * part.size());
      box.hi[row] = std::max(box.hi[row], r[3] + part.support(n) + room);
      box.lo[row] = std::min(box.lo[row], r[3] - part.support(scaled(-1, n)) - room);
    }
  }
  return box;
}

}  // namespace

Box boxOf(const Mesh& mesh, const std::array<double, 12>& m) {
  if (!mesh.parts.empty()) return boxOfCutter(mesh.parts, m);
  // Not yet a Box: reading back as vectors what has just been stored number by number stalls.
  std::array<Interval, 3> axes;
  double magnitude = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &m[4 * row];
    double middle = r[3], half = 0;
    for (int k = 0; k < 3; ++k) middle += r[k] * mesh.origin[k];
    for (int k = 0; k < 3; ++k) {
      middle += r[k] * mesh.box.middle(k);
      half += std::abs(r[k]) * 0.5 * (mesh.box.hi[k] - mesh.box.lo[k]);
    }
    magnitude = std::max(magnitude, magnitudeAlong(r, mesh.span()));
    axes[row] = {middle - half, middle + half};
  }
  const double room = 0x1p-47 * magnitude;
  Box box;
  for (int row = 0; row < 3; ++row) {
    box.lo[row] = axes[row].lo - room;
    box.hi[row] = axes[row].hi + room;
  }
  return box;
}

double determinant(const Transform& pose) {
  const std::array<double, 12>& m = pose.m;
  return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) + m[2] * (m[4] * m[9] - m[5] * m[8]);
}

Vector transformPoint(const Transform& pose, const float* p) {
  const FloatEnvironment floats;
  return placed(pose, p);
}

std::array<Vector, 3> placedTriangle(const Mesh& mesh, const Transform& worldFromMesh, uint32_t triangle) {
  std::array<Vector, 3> corners;
  for (size_t i = 0; i < 3; ++i) {
    const size_t vertex = mesh.indices[3 * size_t{triangle} + i];
    corners[i] = placed(worldFromMesh, &mesh.positions[3 * vertex]);
  }
  return corners;
}

double placedMagnitude(const Vector& farthest, const Transform& worldFromMesh) {
  const double* m = worldFromMesh.m.data();
  const double greatest =
      std::max({magnitudeAlong(m, farthest), magnitudeAlong(m + 4, farthest), magnitudeAlong(m + 8, farthest)});
  return std::min(greatest, std::numeric_limits<double>::max());
}

}  // namespace radar
