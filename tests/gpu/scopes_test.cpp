// Compares the scopes with a raster on the CPU in double precision, pixel by pixel.
#include <algorithm>
#include <cmath>

#include "gpu/device.h"
#include "support/catch.h"
#include "support/test_device.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using test::at;
using Vector = std::array<double, 3>;

double dot(const Vector& a, const Vector& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// The window of a Scopes and the error of snapping to subpixels.
struct Window {
  explicit Window(const Scopes& s) : scopes(s) {
    const uint32_t bits = test::device().impl().properties.limits.subPixelPrecisionBits;
    snap = std::ldexp(1.0, 1 - static_cast<int>(bits));
  }
  // Window coordinates: pixels across the motion, world units along it.
  Vector operator()(const Vector& world) const {
    const Vector offset{world[0] - scopes.origin[0], world[1] - scopes.origin[1], world[2] - scopes.origin[2]};
    return {dot(offset, scopes.right) / scopes.pixel, dot(offset, scopes.up) / scopes.pixel,
            dot(offset, scopes.forward)};
  }
  const Scopes& scopes;
  double snap;
};

// Placement error of a mesh if floats are rounded to nearest: 8 u times the greatest coordinate of its rotated box
// relative to the sensor. docs/method.md allows twice that, for any rounding.
double placementError(const MeshView& mesh, const Transform& pose, const Scopes& scopes, const Vector& about) {
  std::array<float, 3> lo{3e38f, 3e38f, 3e38f}, hi{-3e38f, -3e38f, -3e38f};
  for (uint32_t vertex : mesh.indices) {
    for (int k = 0; k < 3; ++k) {
      lo[k] = std::min(lo[k], mesh.positions[3 * size_t{vertex} + k]);
      hi[k] = std::max(hi[k], mesh.positions[3 * size_t{vertex} + k]);
    }
  }
  double worst = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const float p[3] = {corner & 1 ? hi[0] : lo[0], corner & 2 ? hi[1] : lo[1], corner & 4 ? hi[2] : lo[2]};
    Vector world = transformPoint(pose, p);
    for (int k = 0; k < 3; ++k) world[k] -= about[k];
    for (const Vector& axis : {scopes.right, scopes.up, scopes.forward})
      worst = std::max(worst, std::abs(dot(world, axis)));
  }
  return 8 * 0x1p-24 * worst;
}

// The nearest (sign 1) or farthest (sign -1) depth at each pixel centre, its tolerance, and whether the centre is too
// close to a projected edge to compare.
struct Raster {
  Raster(uint32_t w, uint32_t h)
      : width(w), height(h), depth(size_t{w} * h, NAN), tolerance(depth.size()), unsure(depth.size()) {}

  void add(const Vector (&p)[3], double sign, double error, double snap, double pixel) {
    double lo[2] = {1e300, 1e300}, hi[2] = {-1e300, -1e300};
    for (const Vector& corner : p) {
      for (int k = 0; k < 2; ++k) {
        lo[k] = std::min(lo[k], corner[k]);
        hi[k] = std::max(hi[k], corner[k]);
      }
    }
    const int x0 = std::max(0, int(std::floor(lo[0] - 1))), x1 = std::min(int(width) - 1, int(std::ceil(hi[0] + 1)));
    const int y0 = std::max(0, int(std::floor(lo[1] - 1))), y1 = std::min(int(height) - 1, int(std::ceil(hi[1] + 1)));
    for (int y = y0; y <= y1; ++y) {
      for (int x = x0; x <= x1; ++x) addAt(size_t(y) * width + x, {x + 0.5, y + 0.5, 0}, p, sign, error, snap, pixel);
    }
  }

  void addAt(size_t at, const Vector& centre, const Vector (&p)[3], double sign, double error, double snap,
             double pixel) {
    int left = 0, right = 0;
    for (int i = 0; i < 3; ++i) {
      const Vector &a = p[i], &b = p[(i + 1) % 3];
      const double ex = b[0] - a[0], ey = b[1] - a[1], ox = centre[0] - a[0], oy = centre[1] - a[1];
      const double along = std::clamp((ox * ex + oy * ey) / std::max(ex * ex + ey * ey, 1e-300), 0.0, 1.0);
      if (std::hypot(ox - along * ex, oy - along * ey) <= snap) unsure[at] = 1;
      const double side = ex * oy - ey * ox;
      left += side > 0;
      right += side < 0;
    }
    if (left != 3 && right != 3) return;
    const double ax = p[1][0] - p[0][0], ay = p[1][1] - p[0][1], az = p[1][2] - p[0][2];
    const double bx = p[2][0] - p[0][0], by = p[2][1] - p[0][1], bz = p[2][2] - p[0][2];
    const double area = ax * by - ay * bx;
    const double gx = (az * by - bz * ay) / area, gy = (bz * ax - az * bx) / area;
    const double w = p[0][2] + gx * (centre[0] - p[0][0]) + gy * (centre[1] - p[0][1]);
    const double slope = std::abs(gx) + std::abs(gy);
    const double slack = slope * (snap + error / pixel) + error;
    if (sign > 0 && std::abs(w) <= slack) unsure[at] = 1;  // the back plane may or may not clip it
    if (sign > 0 && w < 0) return;
    if (!(sign * w >= sign * depth[at])) {
      // Another surface within its tolerance could win instead; keep the larger tolerance of the two.
      const double old = std::isnan(depth[at]) ? 0 : tolerance[at];
      const bool close = !std::isnan(depth[at]) && std::abs(w - depth[at]) < old + slack;
      depth[at] = w;
      tolerance[at] = close ? std::max(old, slack) + std::abs(slack - old) : slack;
    } else if (std::abs(w - depth[at]) < tolerance[at] + slack) {
      tolerance[at] += slack;
    }
  }

  uint32_t width, height;
  std::vector<double> depth, tolerance;
  std::vector<char> unsure;
};

void addMesh(Raster& raster, const Window& window, const MeshView& mesh, const Transform& pose, double sign,
             double error) {
  for (size_t i = 0; i < mesh.indices.size(); i += 3) {
    Vector p[3];
    for (size_t k = 0; k < 3; ++k)
      p[k] = window(transformPoint(pose, &mesh.positions[3 * size_t{mesh.indices[i + k]}]));
    raster.add(p, sign, error, window.snap, window.scopes.pixel);
  }
}

struct ComparedPixels {
  size_t pixels = 0, covered = 0;
};

void checkPicture(const Raster& raster, const std::vector<float>& picture, double d, bool fromFarEnd,
                  ComparedPixels& count) {
  const double ulps = 4 * d * 0x1p-23;
  size_t wrongCoverage = 0, wrongDepth = 0;
  double worst = 0;
  for (size_t i = 0; i < picture.size(); ++i) {
    if (raster.unsure[i]) continue;
    double truth = fromFarEnd ? d - raster.depth[i] : raster.depth[i];
    // A surface at or beyond the far end reads as empty or as d.
    if (!fromFarEnd && truth > d - raster.tolerance[i] - ulps) continue;
    ++count.pixels;
    const bool covered = !std::isnan(truth);
    count.covered += covered;
    wrongCoverage += covered == std::isnan(picture[i]);
    if (!covered || std::isnan(picture[i])) continue;
    const double excess = std::abs(picture[i] - truth) - raster.tolerance[i] - ulps;
    worst = std::max(worst, excess);
    wrongDepth += excess > 0;
  }
  CAPTURE(fromFarEnd, d, worst);
  CHECK(wrongCoverage == 0);
  CHECK(wrongDepth == 0);
}

void checkScopes(const Scene& scene, const Query& query, const Scopes& scopes, ComparedPixels& count) {
  REQUIRE(scopes.R.size() == size_t{scopes.width} * scopes.height);
  const Window window(scopes);
  const MeshView sensor = scene.mesh(query.mesh);
  Vector about{};
  for (int k = 0; k < 3; ++k) {
    // The centre of the window is close enough to the sensor's centre for an error bound.
    about[k] = scopes.origin[k] + 0.5 * scopes.pixel * (scopes.width * scopes.right[k] + scopes.height * scopes.up[k]) +
               0.5 * scopes.length * scopes.forward[k];
  }
  const double sensorError = placementError(sensor, query.worldFromMesh, scopes, about);
  Raster mask(scopes.width, scopes.height), range(scopes.width, scopes.height);
  addMesh(mask, window, sensor, query.worldFromMesh, -1, sensorError);
  for (ObjectId id = 0; id < scene.objectLimit(); ++id) {
    const Object& object = scene.object(id);
    if (std::find(query.exclude.begin(), query.exclude.end(), id) != query.exclude.end()) continue;
    const MeshView mesh = scene.mesh(object.mesh);
    addMesh(range, window, mesh, object.worldFromMesh, 1, placementError(mesh, object.worldFromMesh, scopes, about));
  }
  checkPicture(mask, scopes.M, scopes.d, true, count);
  checkPicture(range, scopes.R, scopes.d, false, count);
  for (size_t i = 0; i < scopes.L.size(); ++i) {
    const bool both = !std::isnan(scopes.R[i]) && !std::isnan(scopes.M[i]);
    REQUIRE(both != std::isnan(scopes.L[i]));
    if (both) REQUIRE(std::abs(scopes.L[i] - (scopes.R[i] + scopes.M[i] - scopes.d)) <= 4 * scopes.d * 0x1p-23);
  }
}

ComparedPixels checkWorkload(const tools::Workload& workload, uint32_t resolution) {
  ComparedPixels count;
  tools::ScenePlayer player(workload);
  Sweeper sweeper(test::device(), player.scene());
  for (const tools::Batch& batch : tools::batchesOf(workload.queries, resolution)) {
    player.show(batch.scene);
    for (size_t i = 0; i < batch.queries.size(); ++i) {
      const Query& query = batch.queries[i];
      INFO("query " << workload.queries[batch.numbers[i]].id << " at " << resolution);
      checkScopes(player.scene(), query, sweeper.scopes(query), count);
    }
  }
  return count;
}

// Adds a mesh of one square across z, made of two triangles.
MeshId addSquare(Scene& scene, float side) {
  const float h = side / 2;
  const std::vector<float> positions{-h, -h, 0, h, -h, 0, h, h, 0, -h, h, 0};
  const std::vector<uint32_t> indices{0, 1, 2, 0, 2, 3};
  return scene.addMesh(positions, indices);
}

}  // namespace

TEST_CASE("the scopes equal a double-precision raster on soups of every kind") {
  const uint64_t seed = GENERATE(1, 2);
  const double origin = GENERATE(0.0, 1e6);
  const uint32_t resolution = GENERATE(17, 64, 256);
  const tools::Workload workload =
      tools::makeWorkload(tools::Soups{.objects = 20, .sensors = 18, .origin = origin, .seed = seed});
  const ComparedPixels count = checkWorkload(workload, resolution);
  CHECK(count.pixels > 1000);
  CHECK(count.covered > 100);
}

TEST_CASE("the scopes equal a double-precision raster on teapots among boxes") {
  const uint32_t resolution = GENERATE(64, 200);
  const ComparedPixels count =
      checkWorkload(tools::makeWorkload(tools::Figure7{.teapots = 5, .boxes = 500, .steps = 1}), resolution);
  CHECK(count.covered > 1000);
}

TEST_CASE("R, M and L of two squares are the paper's: L = R + M - d, and M is measured from the far end") {
  Scene scene;
  const MeshId square = addSquare(scene, 2), small = addSquare(scene, 1);
  scene.addObject({small, at(0.45, 0.5, 5), ~0u});
  // The sensor leans: its side at +x lies one unit further along the motion than its side at -x.
  const Transform leaning{{1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1, 0}};
  const Query query{.mesh = square, .worldFromMesh = leaning, .direction = {0, 0, 3}, .distance = 10, .resolution = 64};
  Sweeper sweeper(test::device(), scene);
  const Scopes scopes = sweeper.scopes(query);
  CHECK(scopes.d == Approx(11));
  CHECK(scopes.length == Approx(1));
  double least = 1e300;
  for (uint32_t y = 0; y < scopes.height; ++y) {
    for (uint32_t x = 0; x < scopes.width; ++x) {
      const size_t i = size_t{y} * scopes.width + x;
      double world[3];
      for (int k = 0; k < 3; ++k) {
        world[k] = scopes.origin[k] + scopes.pixel * ((x + 0.5) * scopes.right[k] + (y + 0.5) * scopes.up[k]);
      }
      // From the far end at z = 10.5, the sensor's surface is at 10.5 - x / 2.
      if (!std::isnan(scopes.M[i])) CHECK(scopes.M[i] == Approx(10.5 - world[0] / 2).margin(0.02));
      const bool inside = world[0] > -0.03 && world[0] < 0.93 && world[1] > 0.02 && world[1] < 0.98;
      if (inside) CHECK(scopes.R[i] == Approx(5.5));
      if (world[0] < -0.07 || world[1] < -0.02) CHECK(std::isnan(scopes.R[i]));
      if (!std::isnan(scopes.L[i])) least = std::min(least, double(scopes.L[i]));
    }
  }
  // The sensor meets the square's far edge first: 5 - 0.95 / 2, at the last pixel centre before x = 0.95.
  CHECK(least == Approx(4.525).margin(scopes.pixel));
  CHECK(scopes.result.paperMinL == Approx(least));
  CHECK(scopes.result.t == Approx(4.525).epsilon(1e-6));
}

TEST_CASE("an object that covers no pixel centre is not detected, and the answer is undecided") {
  Scene scene;
  const MeshId square = addSquare(scene, 2), speck = addSquare(scene, 1e-4f);
  scene.addObject({speck, at(0.3, 0.3, 5), ~0u});
  Sweeper sweeper(test::device(), scene);
  const Query query{.mesh = square, .direction = {0, 0, 1}, .distance = 10, .resolution = 16};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.detected == Detected::no);
  CHECK(result.status == Status::undecided);
  CHECK(result.tier == Tier::sampled);
  CHECK(result.hi == INFINITY);
  CHECK(result.lo == 0);
}

TEST_CASE("an object beside the sensor but inside its window is detected and has no L") {
  // A triangle sensor leaves half of its window empty; the object stands there.
  Scene scene;
  const std::vector<float> positions{-1, -1, 0, 1, -1, 0, -1, 1, 0};
  const MeshId half = scene.addMesh(positions, std::vector<uint32_t>{0, 1, 2}), small = addSquare(scene, 0.2f);
  scene.addObject({small, at(0.7, 0.7, 5), ~0u});
  Sweeper sweeper(test::device(), scene);
  const Query query{.mesh = half, .direction = {0, 0, 1}, .distance = 10, .resolution = 64};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.detected == Detected::yes);
  CHECK(result.status == Status::undecided);
  CHECK(std::isnan(result.paperMinL));
}

TEST_CASE("a negative L counts for the paper's minimum but never as a contact") {
  // The sensor is a frame of two plates with the object between them, which one depth layer cannot represent.
  Scene scene;
  const MeshId plate = addSquare(scene, 2), small = addSquare(scene, 0.5f);
  std::vector<float> positions;
  for (float z : {0.0f, 4.0f}) {
    for (float y : {-1.0f, 1.0f}) {
      for (float x : {-1.0f, 1.0f}) positions.insert(positions.end(), {x, y, z});
    }
  }
  const MeshId frame = scene.addMesh(positions, std::vector<uint32_t>{0, 1, 2, 1, 3, 2, 4, 5, 6, 5, 7, 6});
  scene.addObject({small, at(0.1, 0.1, 2), ~0u});
  scene.addObject({plate, at(0.05, 0.05, 9), ~0u});
  Sweeper sweeper(test::device(), scene);
  const Query query{.mesh = frame, .direction = {0, 0, 1}, .distance = 10, .resolution = 64};
  const Result result = sweeper.run({&query, 1}, Mode::sampled).results[0];
  CHECK(result.paperMinL == Approx(-2).margin(1e-4));
  CHECK(result.status == Status::hit);
  CHECK(result.object == 1);
  CHECK(result.hi == Approx(5).epsilon(1e-6));
}

TEST_CASE("the clipping planes keep contact at the start and at exactly D") {
  Scene scene;
  const MeshId square = addSquare(scene, 2), small = addSquare(scene, 1);
  scene.addObject({small, at(0.1, 0.05, 3), ~0u});
  Sweeper sweeper(test::device(), scene);
  Query query{.mesh = square, .direction = {0, 0, 1}, .distance = 3.5, .resolution = 64};
  CHECK(sweeper.run({&query, 1}, Mode::sampled).results[0].t == Approx(3));
  query.distance = 3;
  CHECK(sweeper.run({&query, 1}, Mode::sampled).results[0].detected == Detected::yes);
  query.distance = 2.9;
  CHECK(sweeper.run({&query, 1}, Mode::sampled).results[0].status == Status::clear);
  query.worldFromMesh = at(0, 0, 3);
  CHECK(sweeper.run({&query, 1}, Mode::sampled).results[0].detected == Detected::yes);
}
