#include "sweep/encode.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace radar {

namespace {

constexpr double kU = 0x1p-24;  // half an ulp of 1 in float

double largest(const Vector& v) {
  return std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
}

// How far a vertex that a shader places may lie from the true one, world units (docs/method.md, "Placement").
double placementError(const Mesh& mesh, const Affine& frameFromMesh) {
  double worst = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromMesh[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * mesh.halfExtent[k];
    worst = std::max(worst, sum);
  }
  return 8 * kU * worst;
}

// What double precision may lose between `place` and the frame, world units.
double doubleError(const Mesh& mesh, const Pose& pose, const Vector& origin) {
  double worst = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &pose.m[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * (std::abs(mesh.centre[k]) + mesh.halfExtent[k]);
    worst = std::max(worst, sum);
  }
  return 0x1p-47 * (worst + largest(origin));
}

// The turned vertices' own box: tighter than the turned box, and M fills the window. Padded by its rounding.
Box tightBox(const Mesh& mesh, const Affine& m) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const auto x = static_cast<float>(m[4 * row]), y = static_cast<float>(m[4 * row + 1]),
               z = static_cast<float>(m[4 * row + 2]);
    const float *px = mesh.recentred[0].data(), *py = mesh.recentred[1].data(), *pz = mesh.recentred[2].data();
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

// clip.xy = 2 (frame.xy - corner) / (pixel * resolution) - 1; clip.z = scaleZ * frame.z + offsetZ.
std::array<float, 12> clipFrom(const Affine& frameFromMesh, const Box& window, double pixel, uint32_t resolution,
                               double scaleZ, double offsetZ) {
  const double across = 2 / (pixel * resolution);
  const double scale[3] = {across, across, scaleZ};
  const double offset[3] = {-across * window.lo[0] - 1, -across * window.lo[1] - 1, offsetZ};
  std::array<float, 12> out;
  for (int row = 0; row < 3; ++row) {
    for (int k = 0; k < 4; ++k) {
      const double value = scale[row] * frameFromMesh[4 * row + k] + (k == 3 ? offset[row] : 0);
      out[4 * row + k] = static_cast<float>(value);
    }
  }
  return out;
}

bool excluded(const Query& query, ObjectId object) {
  return std::find(query.exclude.begin(), query.exclude.end(), object) != query.exclude.end();
}

bool overlaps(const Box& a, const Box& b, double slack) {
  for (int k = 0; k < 3; ++k) {
    if (a.lo[k] > b.hi[k] + slack || a.hi[k] < b.lo[k] - slack) return false;
  }
  return true;
}

struct Reached {
  ObjectId object;
  Affine frameFromMesh;
};

// Objects in the swept prism, by id.
std::vector<Reached> collectReached(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy,
                                    const Prism& prism, double& farthest, double& error) {
  thread_local std::vector<ObjectId> ids;
  ids.clear();
  hierarchy.collect(prism, ids);
  std::sort(ids.begin(), ids.end());
  std::vector<Reached> reached;
  for (ObjectId id : ids) {
    const Object& object = scene.objects[id].object;
    if ((object.mask & query.mask) == 0 || excluded(query, id)) continue;
    const Mesh& mesh = scene.meshes[object.mesh];
    const Affine m = frameFromRecentred(prism.axes, prism.origin, object.worldFromMesh, mesh.centre);
    const Box box = boxOfRecentred(mesh, m);
    if (!overlaps(box, prism.box, doubleError(mesh, object.worldFromMesh, prism.origin))) continue;
    farthest = std::max(farthest, box.hi[2]);
    error = std::max(error, placementError(mesh, m));
    reached.push_back({id, m});
  }
  return reached;
}

// Where the sensor is, as its view sees it.
struct SensorWindow {
  Vector origin;         // of the view's frame: the sensor's centre, world
  Affine frameFromMesh;  // from recentred vertices
  Box box;               // the sensor's extents in the frame; widened by `margin` across
  double margin, error, size;
};

SensorWindow lookAlong(const std::array<Vector, 3>& axes, const Query& query, const Mesh& sensor) {
  SensorWindow w;
  w.origin = transform(query.worldFromMesh, sensor.centre);
  w.frameFromMesh = frameFromRecentred(axes, w.origin, query.worldFromMesh, sensor.centre);
  w.error = placementError(sensor, w.frameFromMesh) + doubleError(sensor, query.worldFromMesh, w.origin);
  w.box = tightBox(sensor, w.frameFromMesh);
  w.size = 0;
  for (int k = 0; k < 3; ++k) w.size = std::max(w.size, w.box.hi[k] - w.box.lo[k]);
  w.margin = std::max(64 * w.error, 1e-5 * w.size);
  // A sensor without extent (a point) still gets a window.
  if (w.margin == 0) w.margin = std::max(1e-5 * query.distance, 1e-30);
  for (int k = 0; k < 2; ++k) {
    w.box.lo[k] -= w.margin;
    w.box.hi[k] += w.margin;
  }
  return w;
}

// What the scene in reach adds to a view.
struct Reach {
  std::vector<Reached> objects;
  double depth = 0;  // from the back plane to the farthest of them, d at most
  double error = 0;  // the greatest placement error
};

Reach reachOf(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, const SensorWindow& window,
              const ViewPlan& plan) {
  Prism prism{window.origin, plan.axes, window.box};
  prism.box.hi[2] = window.box.lo[2] + plan.d;
  for (int k = 0; k < 3; ++k) {
    prism.box.lo[k] -= window.error;
    prism.box.hi[k] += window.error;
  }
  Reach reach;
  double farthest = window.box.lo[2];
  reach.objects = collectReached(query, scene, hierarchy, prism, farthest, reach.error);
  reach.depth = std::min(plan.d, std::max(farthest - window.box.lo[2], 0.0));
  return reach;
}

uint32_t pixelsAcross(const SensorWindow& window, int axis, double pixel, uint32_t resolution) {
  const double pixels = std::ceil((window.box.hi[axis] - window.box.lo[axis]) / pixel);
  return std::clamp(static_cast<uint32_t>(pixels), 1u, resolution);
}

void fillView(gpu::View& view, const Query& query, const SensorWindow& window, const Reach& reach, const ViewPlan& plan,
              uint32_t resolution, uint32_t subPixelBits) {
  // The far plane lies a little behind what must be seen, so that contact exactly at D is not cut off.
  const double rangeScale = reach.depth + std::max({64 * kU * reach.depth, 2 * reach.error, window.margin});
  const double maskScale = plan.length + 2 * window.margin;
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), view.pose);
  std::copy(query.direction.begin(), query.direction.end(), view.direction);
  view.directionLength = lengthOf(query.direction);
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
  view.slack = static_cast<float>(reach.error + window.error + 4 * kU * (rangeScale + maskScale));
  view.snap = static_cast<float>(std::ldexp(1.0, -static_cast<int>(subPixelBits)) +
                                 (reach.error + window.error) / plan.pixel + 6 * kU * resolution);
  view.rangeSlack = static_cast<float>(reach.error / rangeScale + 8 * kU);
  view.maskSlack = static_cast<float>(window.error / maskScale + 8 * kU);
}

}  // namespace

uint32_t chooseResolution(double windowSide, double meanEdge) {
  const double wanted = meanEdge > 0 ? 4 * windowSide / meanEdge : 512;
  return std::bit_ceil(static_cast<uint32_t>(std::clamp(wanted, 64.0, 512.0)));
}

ViewPlan encode(const Query& query, const Scene::Impl& scene, const Hierarchy& hierarchy, uint32_t subPixelBits,
                bool select) {
  ViewPlan plan;
  const Mesh& sensor = scene.meshes[query.mesh];
  plan.axes = axesAlong(query.direction);
  const SensorWindow window = lookAlong(plan.axes, query, sensor);
  plan.length = window.box.hi[2] - window.box.lo[2];
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
  const Reach reach = reachOf(query, scene, hierarchy, window, plan);
  fillView(plan.view, query, window, reach, plan, resolution, subPixelBits);

  // The scales as the shaders see them, rounded to float: pictures and what is read from them agree.
  const double backPlane = window.box.lo[2];
  const double rangeScale = plan.view.rangeScale, maskScale = plan.view.maskScale, maskBase = plan.view.maskBase;
  plan.mask = {kNone, query.mesh,
               clipFrom(window.frameFromMesh, window.box, plan.pixel, resolution, -1 / maskScale,
                        (maskBase + backPlane) / maskScale)};
  if (reach.objects.empty()) return plan;
  const auto addRange = [&](std::vector<Placed>& to, ObjectId id, const Affine& m) {
    const MeshId mesh = scene.objects[id].object.mesh;
    to.push_back({id, mesh, clipFrom(m, window.box, plan.pixel, resolution, 1 / rangeScale, -backPlane / rangeScale)});
    plan.triangles += scene.meshes[mesh].triangleCount();
  };
  plan.triangles += sensor.triangleCount();
  for (const Reached& r : reach.objects) addRange(plan.inReach, r.object, r.frameFromMesh);
  if (select) return plan;
  auto next = reach.objects.begin();
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (next != reach.objects.end() && next->object == id) {
      ++next;
    } else if (scene.objects[id].used && (scene.objects[id].object.mask & query.mask) != 0 && !excluded(query, id)) {
      const Object& object = scene.objects[id].object;
      const Mesh& mesh = scene.meshes[object.mesh];
      addRange(plan.others, id, frameFromRecentred(plan.axes, window.origin, object.worldFromMesh, mesh.centre));
    }
  }
  return plan;
}

}  // namespace radar
