#include "sweep/bounded_plan.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "sweep/cluster_walk.h"

namespace radar {

namespace {

// Beyond so many pixels, and with entries of a matrix beyond this, products of floats could overflow; with either no
// pixel is told from another anyway.
constexpr double kMaxPixels = 0x1p40, kMaxEntry = 0x1p80;
// What a part below float's normal range may lose, pixels.
constexpr double kUnderflow = 0x1p-30;

// Lavapipe ends loops silently after 65,535 iterations of an invocation.
constexpr uint64_t kMostLoops = 50'000;

// From so many pixels of its cluster's box for each triangle, drawing by pixel is cheaper (docs/method.md).
constexpr uint64_t kLargeTriangle = 64;

// Clusters are held against so many boxes one by one; with more it would cost what it saves.
constexpr size_t kMostBoxes = 64;

// A window's pixels: frame coordinates (less the corner, across) times `scale`.
struct PixelGrid {
  explicit PixelGrid(const SensorWindow& window, uint32_t resolution) {
    const double width = window.box.hi[0] - window.box.lo[0], height = window.box.hi[1] - window.box.lo[1];
    pixel = std::max(width, height) / resolution;
    scale = 1 / pixel;
    corner = {window.box.lo[0], window.box.lo[1], 0};
    const auto across = [&](double side) {
      return std::clamp(static_cast<uint32_t>(std::ceil(side / pixel)), 1u, resolution);
    };
    columns = across(width);
    rows = across(height);
  }
  double pixel, scale;
  Vector corner;
  uint32_t columns, rows;
};

// Places a mesh in the grid, with bounds for what float loses (docs/method.md, "Outer scopes"); false where float is
// not enough.
bool place(const PixelGrid& grid, const Mesh& mesh, const Affine& frameFromMesh, double error, gpu::Band& band) {
  for (int row = 0; row < 3; ++row) {
    double sum = 0;
    for (int k = 0; k < 4; ++k) {
      const double entry =
          grid.scale * (frameFromMesh[4 * row + k] - (k == 3 ? grid.corner[static_cast<size_t>(row)] : 0));
      if (!(std::abs(entry) < kMaxEntry)) return false;
      band.pixelsFromMesh[4 * row + k] = static_cast<float>(entry);
      sum += std::abs(entry) * (k == 3 ? 1 : mesh.halfExtent[static_cast<size_t>(k)]);
    }
    if (!(sum < kMaxPixels)) return false;
  }
  const float* half = mesh.halfExtent.data();
  if (!(half[0] + half[1] + half[2] < kMaxEntry)) return false;
  // `error` holds 8u of the vertex in the frame, of which 6 are due; the corner is moved here, and a quarter more makes
  // room for widening by these bounds in float.
  const double moved = 8 * kFloatUnit * std::max(std::abs(grid.corner[0]), std::abs(grid.corner[1]));
  band.snap = upward(grid.scale * (1.25 * error + moved) + 4 * kFloatUnit + kUnderflow);
  band.slack = upward(grid.scale * 1.25 * error + kUnderflow);
  return band.slack < kMaxPixels;
}

// Adds the pixels of the window that a box meets. One pixel more on each side makes room for rounding.
void addBand(const PixelGrid& grid, const Box& box, gpu::Band band, std::vector<gpu::Band>& bands) {
  const auto pixelAt = [&](double x, int axis, double more, uint32_t limit) {
    const double at = std::floor((x - grid.corner[static_cast<size_t>(axis)]) * grid.scale) + more;
    return static_cast<uint32_t>(std::clamp(at, 0.0, static_cast<double>(limit)));
  };
  band.firstColumn = pixelAt(box.lo[0], 0, -1, grid.columns);
  band.endColumn = pixelAt(box.hi[0], 0, 2, grid.columns);
  band.firstRow = pixelAt(box.lo[1], 1, -1, grid.rows);
  band.endRow = pixelAt(box.hi[1], 1, 2, grid.rows);
  band.fromRow = band.firstRow;
  band.toRow = band.endRow;
  if (band.firstColumn < band.endColumn && band.firstRow < band.endRow) bands.push_back(band);
}

// Bands of a bounded number of pixels.
void cut(std::vector<gpu::Band>& bands) {
  std::vector<gpu::Band> whole;
  whole.swap(bands);
  for (gpu::Band band : whole) {
    const uint32_t height = std::max(1u, gpu::kBandPixels / (band.endColumn - band.firstColumn));
    for (; band.fromRow < band.endRow; band.fromRow = band.toRow) {
      band.toRow = std::min(band.fromRow + height, band.endRow);
      bands.push_back(band);
    }
  }
}

// How a side is drawn, by the pixels that its clusters take for each triangle unless `byPixel` says it: the rows of a
// strip, or 0 and the bands are cut.
uint32_t stripOf(const BoundedPlan& plan, std::vector<gpu::Band>& bands, std::optional<bool> byPixel) {
  uint64_t pixels = 0, triangles = 0;
  for (const gpu::Band& band : bands) {
    pixels += uint64_t{band.endColumn - band.firstColumn} * (band.endRow - band.firstRow);
    triangles += band.triangles;
  }
  uint64_t rows = 0;
  if (triangles > 0 && byPixel.value_or(pixels >= kLargeTriangle * triangles)) {
    // Loops of an invocation: two for each of its groups of pixels, one for each triangle and band.
    const uint64_t perRow = 2 * ((plan.pitch() / gpu::kPixelGroup + gpu::kGroupStep - 1) / gpu::kGroupStep);
    const uint64_t perTriangle = kMostLoops / (triangles + bands.size());
    const uint32_t most = std::max(1u, gpu::kBandPixels / plan.pitch());
    if (perTriangle > 2) rows = std::min<uint64_t>((perTriangle - 2) / perRow, most);
  }
  if (rows == 0) cut(bands);
  return static_cast<uint32_t>(rows);
}

struct Side {
  ObjectId object;
  MeshId mesh;
  const Affine& frameFromMesh;
  double error;
};

// Adds the clusters of one mesh whose boxes meet one of `within`; returns the box around what they share with those.
Box addSide(BoundedPlan& plan, const PixelGrid& grid, const Scene::Impl& scene, const Side& side,
            std::span<const Box> within, std::vector<gpu::Band>& bands) {
  const Mesh& mesh = scene.meshes[side.mesh];
  Box all, around;
  for (const Box& box : within) all.merge(box);
  // Of a cluster only the part across the motion counts that it shares with what it meets.
  const auto clipped = [&](const Box& box) {
    Box met, part = box;
    for (const Box& other : within.size() <= kMostBoxes ? within : std::span<const Box>(&all, 1)) {
      if (overlap(box, other, 0)) met.merge(other);
    }
    for (int k = 0; k < 2; ++k) {
      part.lo[k] = std::max(part.lo[k], met.lo[k]);
      part.hi[k] = std::min(part.hi[k], met.hi[k]);
    }
    return part;
  };
  struct Part {
    uint32_t node;
    Box box;
  };
  thread_local std::vector<Part> parts;
  parts.clear();
  walkClusters(
      mesh.clusters, side.frameFromMesh, side.error, [&](const Box& box) { return overlap(box, all, 0); },
      [&](uint32_t node, const Box& box) {
        const Box part = clipped(box);
        if (part.lo[0] <= part.hi[0]) parts.push_back({node, part});
      });
  if (parts.empty()) return around;
  gpu::Band shape{};
  shape.isSensor = side.object == kNone;
  plan.measurable = plan.measurable && place(grid, mesh, side.frameFromMesh, side.error, shape);
  const auto draw = static_cast<uint32_t>(plan.draws.size());
  plan.draws.push_back({});
  plan.draws.back().mesh = side.mesh;
  plan.draws.back().object = side.object;
  for (const Part& part : parts) {
    const ClusterNode& node = mesh.clusters.nodes[part.node];
    shape.item = static_cast<uint32_t>(plan.items.size());
    shape.triangles = node.count;
    addBand(grid, part.box, shape, bands);
    plan.items.push_back({draw, node.first, node.first + node.count});
    around.merge(part.box);
  }
  return around;
}

}  // namespace

BoundedPlan planBounded(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, uint32_t resolution,
                        std::optional<bool> byPixel) {
  BoundedPlan plan;
  const Mesh& sensor = scene.meshes[query.mesh];
  const SensorWindow window = lookAlong(query, sensor);
  const Reach reach = reachOf(query, scene, hierarchy, window);
  if (reach.objects.empty()) return plan;
  const PixelGrid grid(window, resolution);
  plan.pixel = grid.pixel;
  plan.axes = window.axes;
  for (size_t i = 0; i < 3; ++i) {
    plan.corner[i] = window.origin[i] + window.axes[0][i] * grid.corner[0] + window.axes[1][i] * grid.corner[1];
  }
  gpu::View& view = plan.view;
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), view.pose);
  const Vector direction = scaledDirection(query.direction);
  std::copy(direction.begin(), direction.end(), view.direction);
  view.directionLength = lengthOf(direction);
  view.distance = query.distance;
  view.size = window.size;
  view.mesh = query.mesh;
  view.resolution = resolution;
  view.width = grid.columns;
  view.height = grid.rows;
  view.cell = std::max(1u, (resolution + gpu::kCellsPerSide - 1) / gpu::kCellsPerSide);
  view.rangeLimit = upward(std::min(query.distance * grid.scale, 1e30));

  // What can meet lies in the prism; and of the sensor, what passes over an object's clusters there.
  std::vector<Box> reached;
  for (const Reached& r : reach.objects) {
    const Side side{r.object, scene.objects[r.object].object.mesh, r.frameFromMesh, r.error};
    Box around = addSide(plan, grid, scene, side, {&reach.prism.box, 1}, plan.sceneBands);
    around.lo[2] = -1e300;
    if (around.lo[0] <= around.hi[0]) reached.push_back(around);
  }
  if (plan.sceneBands.empty()) return plan;
  addSide(plan, grid, scene, {kNone, query.mesh, window.frameFromMesh, window.error}, reached, plan.sensorBands);
  if (plan.sensorBands.empty()) plan.sceneBands.clear();
  plan.sceneStrip = stripOf(plan, plan.sceneBands, byPixel);
  plan.sensorStrip = stripOf(plan, plan.sensorBands, byPixel);
  return plan;
}

}  // namespace radar
