#include "sampled/in_frame.h"

#include <algorithm>
#include <cmath>

namespace radar {

bool staysBelow(const Vector& most, const Mesh& mesh, const Affine& m, double least) {
  Vector sizes;
  for (int k = 0; k < 3; ++k) sizes[k] = std::max<double>(least, mesh.reach[k]);
  for (int row = 0; row < 3; ++row) {
    if (!(magnitudeAlong(&m[4 * row], sizes) < most[row])) return false;
  }
  return true;
}

bool fitsFloats(const Mesh& mesh, const Affine& m) {
  return staysBelow({0x1p125, 0x1p125, 0x1p125}, mesh, m, 1);
}

double placementError(const Mesh& mesh, const Affine& frameFromMesh) {
  // The 2^-120 terms cover floats below the normal range: of a product, of an entry per unit of the mesh, of a vertex.
  const Vector reach{mesh.reach[0], mesh.reach[1], mesh.reach[2]};
  double scale = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromMesh[4 * row];
    scale = std::max(scale, norm1({r[0], r[1], r[2]}));
  }
  return 16 * kFloatUnit * placedMagnitude(reach, {frameFromMesh}) + 0x1p-120 * (1 + norm1(reach) + scale);
}

double doubleError(const Mesh& mesh, const Transform& pose, const Vector& origin) {
  return 0x1p-47 * (placedMagnitude(mesh.span(), pose) + largest(origin));
}

Box tightBox(const Mesh& mesh, const Affine& m) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const auto x = static_cast<float>(m[4 * row]), y = static_cast<float>(m[4 * row + 1]),
               z = static_cast<float>(m[4 * row + 2]);
    const float *px = mesh.local[0].data(), *py = mesh.local[1].data(), *pz = mesh.local[2].data();
    float low = 3e38f, high = -3e38f;
    for (uint32_t i = 0; i < mesh.vertexCount(); ++i) {
      const float at = x * px[i] + y * py[i] + z * pz[i];
      low = at < low ? at : low;
      high = at > high ? at : high;
    }
    box.lo[row] = low + m[4 * row + 3];
    box.hi[row] = high + m[4 * row + 3];
  }
  return box;
}

}  // namespace radar
