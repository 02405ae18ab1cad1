#include "cyber_radar/scene_picture.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "cyber_radar/canvas.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr uint32_t kResolution = 1024;
constexpr double kMargin = 16, kCaption = 44;
constexpr Colour kStill{0.55, 0.62, 0.70}, kMoving{0.90, 0.45, 0.05}, kPath{0.75, 0.15, 0.10};
constexpr Vec3 kLight{-0.4, 0.6, -0.69};  // towards the light: from the left, above and the viewer

/// A disc that covers the cube, seen from a corner, and looks to the opposite one.
QuerySpec viewOf(uint32_t scene, uint32_t discMesh) {
  const double a = 1 / std::sqrt(2.0), b = 1 / std::sqrt(6.0), c = 1 / std::sqrt(3.0);
  const double diagonal = kCubeSide / c, back = 0.55 * diagonal * c;
  QuerySpec query;
  query.scene = scene;
  // The columns of the rotation are orthonormal; the third is the disc's axis.
  query.sensor = {discMesh, {{a, -b, -c, back, -a, -b, -c, back, 0, 2 * b, -c, back}}};
  query.direction = {-c, -c, -c};
  query.distance = 1.1 * diagonal;
  return query;
}

/// The slope of the depth across a pixel, on the side where it is less: an edge behind is no slope.
double slope(const std::vector<float>& depth, size_t before, size_t here, size_t after, double pixel) {
  const double down = depth[here] - depth[before], up = depth[after] - depth[here];
  if (std::isnan(down)) return std::isnan(up) ? 0 : up / pixel;
  if (std::isnan(up)) return down / pixel;
  return (std::abs(down) < std::abs(up) ? down : up) / pixel;
}

void drawSurfaces(const Canvas& canvas, const Scopes& all, const Scopes& moving) {
  const auto& depth = all.R;
  for (uint32_t row = 1; row + 1 < all.height; ++row) {
    for (uint32_t column = 1; column + 1 < all.width; ++column) {
      const size_t here = size_t{row} * all.width + column;
      if (std::isnan(depth[here])) continue;
      const double x = slope(depth, here - 1, here, here + 1, all.pixel);
      const double y = slope(depth, here - all.width, here, here + all.width, all.pixel);
      const Vec3 normal{x, y, -1};  // towards the viewer
      const double light = std::max(0.0, dot(normal, kLight)) / lengthOf(normal);
      // Far things fade, so that near ones stand out.
      const double fade = 0.5 * std::min(1.0, depth[here] / (1.9 * kCubeSide));
      const bool moves = std::abs(moving.R[here] - depth[here]) < all.pixel;
      const Colour& base = moves ? kMoving : kStill;
      const Vec3 lit = (0.45 + 0.75 * light) * base;
      canvas.colour(moves ? lit : lit + fade * (kFull - lit));
      canvas.fill(kMargin + column, kMargin + all.height - 1 - row, 1, 1);
    }
  }
}

void drawFlight(const Canvas& canvas, const Scopes& view, const Workload& workload, const Flight& flight) {
  const Transform& pose = flight.query.sensor.worldFromMesh;
  const Vec3 middle = extentOf(workload.meshes[flight.query.sensor.mesh]).middle;
  const Vec3 start = turned(linearPart(pose), middle) + Vec3{pose.m[3], pose.m[7], pose.m[11]};
  const Vec3& direction = flight.query.direction;
  const Vec3 end = start + (flight.distance / lengthOf(direction)) * direction;
  const auto pixelOf = [&](const Vec3& p) {
    const Vec3 offset = p - view.origin;
    return std::pair(kMargin + dot(offset, view.right) / view.pixel,
                     kMargin + view.height - dot(offset, view.up) / view.pixel);
  };
  const auto [x0, y0] = pixelOf(start);
  const auto [x1, y1] = pixelOf(end);
  canvas.colour(kPath);
  cairo_set_line_width(canvas.get(), 2.5);
  cairo_move_to(canvas.get(), x0, y0);
  cairo_line_to(canvas.get(), x1, y1);
  cairo_stroke(canvas.get());
  if (!flight.touches) return;
  cairo_arc(canvas.get(), x1, y1, 5.5, 0, 2 * std::acos(-1.0));
  cairo_fill(canvas.get());
}

}  // namespace

void writeScenePicture(const std::filesystem::path& file, Workload workload, uint32_t scene,
                       const std::vector<Flight>& flights, const Device& device) {
  const uint32_t disc = static_cast<uint32_t>(workload.meshes.size());
  workload.meshes.push_back(makeRod(0.5 * std::sqrt(8.0 / 3) * kCubeSide + 1, 1, 48));
  const uint32_t moving = static_cast<uint32_t>(workload.scenes.size());
  workload.scenes.push_back({"what moves", {}, workload.scenes[scene].instances, {}});
  ScenePlayer player(workload);
  Sweeper sweeper(device, player.scene());
  const Query query = toQuery(viewOf(scene, disc), radar::Mode::sampled, kResolution);
  player.show(scene);
  const Scopes all = sweeper.scopes(query);
  player.show(moving);
  const Scopes movers = sweeper.scopes(query);

  const Canvas canvas(2 * kMargin + all.width, 2 * kMargin + all.height + kCaption);
  drawSurfaces(canvas, all, movers);
  for (const Flight& flight : flights) drawFlight(canvas, all, workload, flight);
  canvas.text(kMargin, kMargin + all.height + 20, 15,
              "The scene as the method sees it: the depth picture R of a disc that looks in from a corner, shaded.");
  canvas.text(kMargin, kMargin + all.height + 40, 15,
              "Orange: what flies. A line shows how far each gets, a dot that something is touched there.");
  canvas.write(file);
}

}  // namespace radar::tools
