#include "cpu/view.h"

#include <algorithm>
#include <cmath>

namespace radar::cpu {

namespace {

/// A power of two that scales `size` to about 1, or 1 if there is none.
double scaleOf(double size) {
  if (!(size > 0 && std::isfinite(size))) return 1;
  const double scale = std::ldexp(1.0, -std::ilogb(size));
  return std::isfinite(scale) ? scale : 1;
}

}  // namespace

View::View(const Vector& sensor, double size, const Vector& w) : origin(sensor), scale(scaleOf(size)) {
  int least = 0;
  for (int k = 1; k < 3; ++k) {
    if (std::abs(w[k]) < std::abs(w[least])) least = k;
  }
  const int i = (least + 1) % 3, j = (least + 2) % 3;
  Vector u{};
  u[i] = -w[j];
  u[j] = w[i];
  const double length = std::sqrt(u[i] * u[i] + u[j] * u[j]);
  for (double& c : u) c /= length;
  axes = {u, cross(w, u), w};
}

ViewedTriangle::ViewedTriangle(const exact::Triangle& world, const View& view) {
  double farthest = 0, sum = 0;
  for (int i = 0; i < 3; ++i) {
    Vector local;
    for (int k = 0; k < 3; ++k) local[k] = view.scale * (world[i][k] - view.origin[k]);
    for (int k = 0; k < 3; ++k) corners[i][k] = dot(view.axes[k], local);
    const double size = norm1(local);
    farthest = std::max(farthest, size);
    sum += size;
  }
  // A maximum may hide a NaN; a sum does not.
  error = std::isfinite(sum) ? 24 * kUnit * farthest : sum;
  for (int k = 0; k < 3; ++k) {
    lo[k] = std::min({corners[0][k], corners[1][k], corners[2][k]}) - error;
    hi[k] = std::max({corners[0][k], corners[1][k], corners[2][k]}) + error;
  }
  const Vector &p = corners[0], &q = corners[1], &r = corners[2];
  area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
  const double width = std::max(hi[0] - lo[0], hi[1] - lo[1]), off = 2 * error + kUnit * width;
  areaError = 4 * width * off + 4 * off * off + 4 * kUnit * width * width;
}

}  // namespace radar::cpu
