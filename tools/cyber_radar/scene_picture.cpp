#include "cyber_radar/scene_picture.h"

#include <algorithm>
#include <cmath>

#include "workloads/shapes.h"

namespace radar::tools {

namespace {

constexpr Colour kStill{0.55, 0.62, 0.70}, kMoving{0.90, 0.45, 0.05};
constexpr Vec3 kLight{-0.4, 0.6, -0.69};  // towards the light: from the left, above and the viewer

/// The slope of the depth across a pixel, on the side where it is less, so that an edge in depth is not a slope.
double slope(const std::vector<float>& depth, size_t before, size_t here, size_t after, double pixel) {
  const double down = depth[here] - depth[before], up = depth[after] - depth[here];
  if (std::isnan(down)) return std::isnan(up) ? 0 : up / pixel;
  if (std::isnan(up)) return down / pixel;
  return (std::abs(down) < std::abs(up) ? down : up) / pixel;
}

}  // namespace

MeshData viewingDisc(double side) {
  return makeRod(0.5 * std::sqrt(8.0 / 3) * side + 1, 1, 48);
}

Query viewOf(uint32_t discMesh, double side, uint32_t resolution) {
  const double a = 1 / std::sqrt(2.0), b = 1 / std::sqrt(6.0), c = 1 / std::sqrt(3.0);
  const double diagonal = side / c, back = 0.55 * diagonal * c;
  Query query;
  query.mesh = discMesh;
  // The columns of the rotation are orthonormal; the third is the disc's axis.
  query.worldFromMesh = {{a, -b, -c, back, -a, -b, -c, back, 0, 2 * b, -c, back}};
  query.direction = {-c, -c, -c};
  query.distance = 1.1 * diagonal;
  query.resolution = resolution;
  return query;
}

std::pair<double, double> pixelOf(const Scopes& view, const Vec3& place, double margin) {
  const Vec3 offset = place - view.origin;
  return {margin + dot(offset, view.right) / view.pixel, margin + view.height - dot(offset, view.up) / view.pixel};
}

void drawSurfaces(const Canvas& canvas, double margin, double side, const Scopes& all, const Scopes& moving) {
  const auto& depth = all.R;
  for (uint32_t row = 1; row + 1 < all.height; ++row) {
    for (uint32_t column = 1; column + 1 < all.width; ++column) {
      const size_t here = size_t{row} * all.width + column;
      if (std::isnan(depth[here])) continue;
      const double x = slope(depth, here - 1, here, here + 1, all.pixel);
      const double y = slope(depth, here - all.width, here, here + all.width, all.pixel);
      const Vec3 normal{x, y, -1};  // towards the viewer
      const double light = std::max(0.0, dot(normal, kLight)) / lengthOf(normal);
      // Far surfaces fade, so that near ones stand out.
      const double fade = 0.5 * std::min(1.0, depth[here] / (1.9 * side));
      const bool moves = std::abs(moving.R[here] - depth[here]) < all.pixel;
      const Colour& base = moves ? kMoving : kStill;
      const Vec3 lit = (0.45 + 0.75 * light) * base;
      canvas.colour(moves ? lit : lit + fade * (kFull - lit));
      canvas.fill(margin + column, margin + all.height - 1 - row, 1, 1);
    }
  }
}

}  // namespace radar::tools
