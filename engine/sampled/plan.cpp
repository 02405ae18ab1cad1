#include "sampled/plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "query/swept.h"
#include "sampled/cluster_walk.h"
#include "scene/placement.h"

namespace radar {

namespace {

// Larger clip coordinates might overflow in products of the identify stage (docs/method.md, "Ranges, infinities and
// rounding"). Units: half the window across, the picture's depth along.
constexpr double kMostAcross = 0x1p40, kMostAlong = 0x1p48;

// The reason why the scopes cannot be drawn, as far as it is known before the view is set up; else empty.
std::string outOfRange(const Query& query, const Scene::Impl& scene) {
  const Vector direction = scaledDirection(query.direction);
  if (std::ilogb(largest(direction)) != 0) {
    return "range: the direction's components differ too much in size for doubles";
  }
  if (!scene.objectTree().inRange()) return "range: an object has coordinates beyond 2^80";
  if (!isInRange(placementOf(scene.meshes[query.mesh], query.worldFromMesh))) {
    return "range: the sensor has coordinates beyond 2^80, or a size below 2^-80";
  }
  return {};
}

// Whether floats can hold the mesh in the window, and the errors of its vertices.
bool fitsWindow(const Mesh& mesh, const Affine& clipFromMesh, double snap, double slack) {
  bool fits = fitsFloats(mesh, clipFromMesh) && snap < kMostAcross && slack < kMostAlong;
  for (int row = 0; row < 3; ++row) {
    const double* r = &clipFromMesh[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * mesh.reach[k];
    fits = fits && sum < (row < 2 ? kMostAcross : kMostAlong);
  }
  return fits;
}

std::array<float, 12> floatsOf(const Affine& m) {
  std::array<float, 12> out;
  for (size_t i = 0; i < m.size(); ++i) out[i] = static_cast<float>(m[i]);
  return out;
}

// clip.xy = 2 (frame.xy - corner) / (pixel * resolution) - 1; clip.z = scaleZ * frame.z + offsetZ.
Affine clipFrom(const Affine& frameFromMesh, const Box& window, double pixel, uint32_t resolution, double scaleZ,
                double offsetZ) {
  const double across = 2 / (pixel * resolution);
  const double scale[3] = {across, across, scaleZ};
  const double offset[3] = {-across * window.lo[0] - 1, -across * window.lo[1] - 1, offsetZ};
  Affine out;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 4; ++k) out[4 * row + k] = scale[row] * frameFromMesh[4 * row + k] + (k == 3 ? offset[row] : 0);
  }
  return out;
}

uint32_t pixelsAcross(const SensorWindow& window, int axis, double pixel, uint32_t resolution) {
  const double pixels = std::ceil((window.box.hi[axis] - window.box.lo[axis]) / pixel);
  return std::clamp(static_cast<uint32_t>(pixels), 1u, resolution);
}

void fillView(gpu::View& view, const Query& query, const SensorWindow& window, const Selection& reach,
              const ViewPlan& plan, uint32_t resolution) {
  // The far plane is a little beyond the depth that must be visible, so that contact exactly at D is not clipped.
  const double rangeScale = reach.depth + std::max({64 * kFloatUnit * reach.depth, 2 * reach.error, window.margin});
  const double maskScale = plan.length + 2 * window.margin;
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), view.pose);
  const Vector direction = scaledDirection(query.direction);
  std::copy(direction.begin(), direction.end(), view.direction);
  view.directionLength = lengthOf(direction);
  view.distance = query.distance;
  view.size = window.size;
  view.mesh = query.mesh;
  view.resolution = resolution;
  view.width = pixelsAcross(window, 0, plan.pixel, resolution);
  view.height = pixelsAcross(window, 1, plan.pixel, resolution);
  view.cell = std::max(2u, 2 * ((resolution + 2 * gpu::kCellsPerSide - 1) / (2 * gpu::kCellsPerSide)));
  view.rangeScale = static_cast<float>(rangeScale);
  view.maskBase = static_cast<float>(plan.length + window.margin);
  view.maskScale = static_cast<float>(maskScale);
  view.slack = static_cast<float>(reach.error + window.error + 4 * kFloatUnit * (rangeScale + maskScale));
  // Stored depths are at most 1.
  view.rangeLimit =
      static_cast<float>(std::min((plan.d + reach.error + window.error) / rangeScale + 4 * kFloatUnit, 2.0));
}

// The box that the scopes can show, without a mesh's own error: whole pixels, which may pass the window's edge, plus
// twice the distance by which snapping and float rounding move a vertex.
Box visibleBox(const SensorWindow& window, const ViewPlan& plan, uint32_t subPixelBits) {
  const double around =
      plan.pixel * 2 * (std::ldexp(1.0, -static_cast<int>(subPixelBits)) + 6 * kFloatUnit * plan.view.resolution);
  const double along = 64 * kFloatUnit * plan.view.rangeScale;
  const double width = plan.pixel * plan.view.width, height = plan.pixel * plan.view.height;
  const auto& lo = window.box.lo;
  return {{lo[0] - around, lo[1] - around, lo[2] - along},
          {lo[0] + width + around, lo[1] + height + around, lo[2] + plan.view.rangeScale + along}};
}

void addWhole(ViewPlan& plan, Placed& placed, const Mesh& mesh) {
  placed.firstRun = static_cast<uint32_t>(plan.runs.size());
  placed.runs = 1;
  plan.runs.push_back({0, mesh.triangleCount()});
}

// Adds the clusters for which `wanted` holds; calls found(box) for each.
template <class Wanted, class Found>
void addClusters(ViewPlan& plan, Placed& placed, const Mesh& mesh, const Affine& frameFromMesh, double error,
                 const Wanted& wanted, const Found& found) {
  placed.firstRun = static_cast<uint32_t>(plan.runs.size());
  walkClusters(mesh, frameFromMesh, error, wanted, [&](const MeshTree::Below& cluster, const Box& box) {
    const bool follows =
        plan.runs.size() > placed.firstRun && plan.runs.back().first + plan.runs.back().count == cluster.first;
    if (!follows) plan.runs.push_back({cluster.first, 0});
    plan.runs.back().count += cluster.count;
    found(box);
  });
  placed.runs = static_cast<uint32_t>(plan.runs.size()) - placed.firstRun;
}

// Fills inReach, unless no cluster meets the swept prism, and `mask`, unless it is drawn whole.
void addReached(ViewPlan& plan, const Scene::Impl& scene, const Selection& reach, const Box& visible, Drawn drawn,
                const Mesh& sensor, const SensorWindow& window, const auto& placeInRange) {
  bool inPrism = false;
  std::vector<Box> columns;  // around the visible clusters of each object, unbounded along the motion
  for (const SelectedObject& r : reach.objects) {
    Placed placed = placeInRange(r.object, r.frameFromMesh, r.error);
    const Mesh& mesh = scene.meshes[placed.mesh];
    Box around;
    addClusters(
        plan, placed, mesh, r.frameFromMesh, r.error, [&](const Box& box) { return overlap(box, visible, 0); },
        [&](const Box& box) {
          inPrism = inPrism || overlap(box, reach.prism.box, 0);
          around.merge(box);
        });
    if (placed.runs == 0) continue;
    if (drawn == Drawn::everything) {
      plan.runs.resize(placed.firstRun);
      addWhole(plan, placed, mesh);
    }
    around.lo[2] = -1e300;
    around.hi[2] = 1e300;
    columns.push_back(around);
    plan.inReach.push_back(placed);
  }
  if (!inPrism) {
    plan.inReach.clear();
    plan.runs.resize(plan.mask.runs);
  }
  if (drawn != Drawn::inReach || !inPrism) return;
  // A pixel in both R and M is in a column and in the box of a cluster of the sensor, each widened by the same
  // snapping.
  const double around = window.box.lo[0] - visible.lo[0];
  const auto passesOver = [&](const Box& box) {
    return std::any_of(columns.begin(), columns.end(), [&](const Box& c) { return overlap(box, c, around); });
  };
  addClusters(plan, plan.mask, sensor, window.frameFromMesh, window.error, passesOver, [](const Box&) {});
}

// Adds objects out of reach. Those that meet the visible box are left out: the scopes reach farther than select by a
// rounding error, which must not change the answer.
void addOthers(ViewPlan& plan, const Query& query, const Scene::Impl& scene, const Selection& reach, const Box& visible,
               const Vector& origin, const auto& placeInRange) {
  auto next = reach.objects.begin();
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (next != reach.objects.end() && next->object == id) {
      ++next;
    } else if (const Object& object = scene.objects[id].object; scene.objects[id].used && takesPart(query, scene, id)) {
      const Mesh& mesh = scene.meshes[object.mesh];
      const Affine m = frameFromLocal(plan.axes, origin, object.worldFromMesh, mesh.origin);
      const double error = placementError(mesh, m);
      if (overlap(boxOfLocal(mesh, m), visible, 2 * error)) continue;
      Placed placed = placeInRange(id, m, error);
      if (!placed.fits) continue;
      plan.others.push_back(placed);
      addWhole(plan, plan.others.back(), mesh);
    }
  }
}

}  // namespace

uint32_t chooseResolution(double windowSide, double meanEdge) {
  const double wanted = meanEdge > 0 ? 4 * windowSide / meanEdge : 512;
  return std::bit_ceil(static_cast<uint32_t>(std::clamp(wanted, 64.0, 512.0)));
}

ViewPlan planSampled(const Query& query, const Scene::Impl& scene, uint32_t subPixelBits, Drawn drawn) {
  ViewPlan plan;
  plan.outOfRange = outOfRange(query, scene);
  if (!plan.outOfRange.empty()) return plan;
  const Mesh& sensor = scene.meshes[query.mesh];
  const SensorWindow window = lookAlong(query, sensor);
  plan.axes = window.axes;
  plan.length = window.length;
  plan.d = plan.length + query.distance;
  const double side = std::max(window.box.hi[0] - window.box.lo[0], window.box.hi[1] - window.box.lo[1]);
  const double scale = std::cbrt(std::abs(determinant(query.worldFromMesh)));
  const uint32_t resolution =
      query.resolution != 0 ? query.resolution : chooseResolution(side, scale * sensor.meanEdge);
  plan.pixel = side / resolution;
  for (int i = 0; i < 3; ++i) {
    plan.corner[i] = window.origin[i];
    for (int k = 0; k < 3; ++k) plan.corner[i] += plan.axes[k][i] * window.box.lo[k];
  }
  const Selection reach = selectionOf(query, scene, window);
  fillView(plan.view, query, window, reach, plan, resolution);

  // The scales are those rounded to float, as shaders use them, so that drawing and reading the scopes agree.
  const double backPlane = window.box.lo[2];
  const double rangeScale = plan.view.rangeScale, maskScale = plan.view.maskScale, maskBase = plan.view.maskBase;
  const auto place = [&](ObjectId object, MeshId mesh, const Affine& m, double error, double scaleZ, double offsetZ) {
    const double snap =
        std::ldexp(1.0, -static_cast<int>(subPixelBits)) + error / plan.pixel + 6 * kFloatUnit * resolution;
    const double slack = error * std::abs(scaleZ) + 8 * kFloatUnit;
    const Affine clip = clipFrom(m, window.box, plan.pixel, resolution, scaleZ, offsetZ);
    if (!fitsWindow(scene.meshes[mesh], clip, snap, slack))
      return Placed{.object = object, .mesh = mesh, .fits = false};
    const Vector& origin = scene.meshes[mesh].origin;
    return Placed{object,
                  mesh,
                  true,
                  floatsOf(clip),
                  {static_cast<float>(origin[0]), static_cast<float>(origin[1]), static_cast<float>(origin[2])},
                  static_cast<float>(snap),
                  static_cast<float>(slack)};
  };
  plan.mask =
      place(kNone, query.mesh, window.frameFromMesh, window.error, -1 / maskScale, (maskBase + backPlane) / maskScale);
  if (drawn != Drawn::inReach) addWhole(plan, plan.mask, sensor);
  const auto placeInRange = [&](ObjectId id, const Affine& m, double error) {
    return place(id, scene.objects[id].object.mesh, m, error, 1 / rangeScale, -backPlane / rangeScale);
  };
  const Box visible = visibleBox(window, plan, subPixelBits);
  addReached(plan, scene, reach, visible, drawn, sensor, window, placeInRange);
  const bool fits = std::all_of(plan.inReach.begin(), plan.inReach.end(), [](const Placed& p) { return p.fits; });
  if (!plan.inReach.empty() && !(plan.mask.fits && fits)) {
    plan.outOfRange =
        "range: an object in reach is too large relative to the sensor, or placed too imprecisely, for floats";
    return plan;
  }
  for (const Run& run : plan.runs) plan.items += (run.count + gpu::kItemTriangles - 1) / gpu::kItemTriangles;
  if (drawn == Drawn::everything && !plan.inReach.empty()) {
    addOthers(plan, query, scene, reach, visible, window.origin, placeInRange);
  }
  for (const Run& run : plan.runs) plan.triangles += run.count;
  return plan;
}

}  // namespace radar
