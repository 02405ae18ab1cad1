#include "sampled/in_frame.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "math/lanes.h"

namespace radar {

namespace {

using FloatLanes = Lanes<float>;

FloatLanes lanesOf(const float* values) {
  Floats lanes;
  std::memcpy(&lanes, values, sizeof(lanes));
  return lanes;
}

}  // namespace

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
  const size_t count = mesh.vertexCount();
  const float *px = mesh.local[0].data(), *py = mesh.local[1].data(), *pz = mesh.local[2].data();
  Box box;
  for (int row = 0; row < 3; ++row) {
    const FloatLanes x = static_cast<float>(m[4 * row]), y = static_cast<float>(m[4 * row + 1]),
                     z = static_cast<float>(m[4 * row + 2]);
    FloatLanes low = 3e38f, high = -3e38f;
    const auto add = [&](const FloatLanes& p, const FloatLanes& q, const FloatLanes& r) {
      const FloatLanes at = x * p + y * q + z * r;
      low = min(at, low);
      high = max(at, high);
    };
    size_t i = 0;
    for (; i + kLanes <= count; i += kLanes) add(lanesOf(px + i), lanesOf(py + i), lanesOf(pz + i));
    for (; i < count; ++i) add(px[i], py[i], pz[i]);
    box.lo[row] = std::min({low[0], low[1], low[2], low[3]}) + m[4 * row + 3];
    box.hi[row] = std::max({high[0], high[1], high[2], high[3]}) + m[4 * row + 3];
  }
  return box;
}

}  // namespace radar
