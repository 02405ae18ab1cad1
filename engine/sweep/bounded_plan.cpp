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

// The pixels of the window that a box meets, cut into bands of a bounded number. One pixel more on each side makes room
// for rounding.
void addBands(const PixelGrid& grid, const Box& box, gpu::Band band, std::vector<gpu::Band>& bands) {
  const auto pixelAt = [&](double x, int axis, double more, uint32_t limit) {
    const double at = std::floor((x - grid.corner[static_cast<size_t>(axis)]) * grid.scale) + more;
    return static_cast<uint32_t>(std::clamp(at, 0.0, static_cast<double>(limit)));
  };
  band.firstColumn = pixelAt(box.lo[0], 0, -1, grid.columns);
  band.endColumn = pixelAt(box.hi[0], 0, 2, grid.columns);
  if (band.firstColumn >= band.endColumn) return;
  const uint32_t end = pixelAt(box.hi[1], 1, 2, grid.rows);
  const uint32_t height = std::max(1u, gpu::kBandPixels / (band.endColumn - band.firstColumn));
  for (uint32_t row = pixelAt(box.lo[1], 1, -1, grid.rows); row < end; row += height) {
    band.firstRow = row;
    band.endRow = std::min(row + height, end);
    bands.push_back(band);
  }
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
    addBands(grid, part.box, shape, bands);
    plan.items.push_back({draw, node.first, node.first + node.count});
    around.merge(part.box);
  }
  return around;
}

}  // namespace

BoundedPlan planBounded(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, uint32_t resolution) {
  BoundedPlan plan;
  const Mesh& sensor = scene.meshes[query.mesh];
  const SensorWindow window = lookAlong(query, sensor);
  const Reach reach = reachOf(query, scene, hierarchy, window);
  if (reach.objects.empty()) return plan;
  const PixelGrid grid(window, resolution);
  plan.pixel = grid.pixel;
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
  return plan;
}

}  // namespace radar
