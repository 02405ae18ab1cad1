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
  const Vector origin = transform(query.worldFromMesh, sensor.centre);
  const Affine sensorFrame = frameFromRecentred(plan.axes, origin, query.worldFromMesh, sensor.centre);
  const double sensorError = placementError(sensor, sensorFrame) + doubleError(sensor, query.worldFromMesh, origin);

  // The window: the sensor's extents, a margin wider. A sensor without width (edge-on, a point) still gets a window.
  Box window = tightBox(sensor, sensorFrame);
  plan.length = window.hi[2] - window.lo[2];
  plan.d = plan.length + query.distance;
  const double extent = std::max(window.hi[0] - window.lo[0], window.hi[1] - window.lo[1]);
  const double size = std::max(extent, plan.length);
  double margin = std::max(64 * sensorError, 1e-5 * size);
  if (margin == 0) margin = std::max(1e-5 * query.distance, 1e-30);
  for (int k = 0; k < 2; ++k) {
    window.lo[k] -= margin;
    window.hi[k] += margin;
  }
  const double side = std::max(window.hi[0] - window.lo[0], window.hi[1] - window.lo[1]);
  const double scale = std::cbrt(std::abs(determinant(query.worldFromMesh)));
  const uint32_t resolution =
      query.resolution != 0 ? query.resolution : chooseResolution(side, scale * sensor.meanEdge);
  plan.pixel = side / resolution;
  const auto pixels = [&](int axis) {
    return std::clamp<uint32_t>(static_cast<uint32_t>(std::ceil((window.hi[axis] - window.lo[axis]) / plan.pixel)), 1,
                                resolution);
  };

  Prism prism{origin, plan.axes, window};
  prism.box.hi[2] = window.lo[2] + plan.d;
  for (int k = 0; k < 3; ++k) {
    prism.box.lo[k] -= sensorError;
    prism.box.hi[k] += sensorError;
  }
  double farthest = window.lo[2], sceneError = 0;
  const std::vector<Reached> reached = collectReached(query, scene, hierarchy, prism, farthest, sceneError);

  const double backPlane = window.lo[2];
  const double maskScale = plan.length + 2 * margin, maskBase = plan.length + margin;
  // The far plane lies a little behind what must be seen, so that contact exactly at D is not cut off.
  const double depth = std::min(plan.d, std::max(farthest - backPlane, 0.0));
  const double rangeScale = depth + std::max({64 * kU * depth, 2 * sceneError, margin});
  const double snap = std::ldexp(1.0, -static_cast<int>(subPixelBits)) + (sceneError + sensorError) / plan.pixel +
                      3 * kU * 2 * resolution;

  gpu::View& view = plan.view;
  std::copy(query.worldFromMesh.m.begin(), query.worldFromMesh.m.end(), view.pose);
  std::copy(query.direction.begin(), query.direction.end(), view.direction);
  view.directionLength = lengthOf(query.direction);
  view.distance = query.distance;
  view.size = size;
  view.mesh = query.mesh;
  view.resolution = resolution;
  view.width = pixels(0);
  view.height = pixels(1);
  view.cell = std::max(2u, 2 * ((resolution + 2 * gpu::kCellsPerSide - 1) / (2 * gpu::kCellsPerSide)));
  view.rangeScale = static_cast<float>(rangeScale);
  view.maskBase = static_cast<float>(maskBase);
  view.maskScale = static_cast<float>(maskScale);
  view.slack = static_cast<float>(sceneError + sensorError + 4 * kU * (rangeScale + maskScale));
  view.snap = static_cast<float>(snap);
  view.rangeSlack = static_cast<float>(sceneError / rangeScale + 8 * kU);
  view.maskSlack = static_cast<float>(sensorError / maskScale + 8 * kU);
  for (int i = 0; i < 3; ++i) {
    plan.corner[i] = origin[i];
    for (int k = 0; k < 3; ++k) plan.corner[i] += plan.axes[k][i] * window.lo[k];
  }

  const double rangeZ = 1 / rangeScale, rangeOffset = -backPlane / rangeScale;
  const auto addRange = [&](std::vector<Placed>& to, ObjectId id, const Affine& m) {
    const MeshId mesh = scene.objects[id].object.mesh;
    to.push_back({id, mesh, clipFrom(m, window, plan.pixel, resolution, rangeZ, rangeOffset)});
    plan.triangles += scene.meshes[mesh].triangleCount();
  };
  plan.mask = {
      kNone, query.mesh,
      clipFrom(sensorFrame, window, plan.pixel, resolution, -1 / maskScale, (maskBase + backPlane) / maskScale)};
  if (reached.empty()) return plan;
  plan.triangles += sensor.triangleCount();
  for (const Reached& r : reached) addRange(plan.inReach, r.object, r.frameFromMesh);
  if (select) return plan;
  auto next = reached.begin();
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (next != reached.end() && next->object == id) {
      ++next;
    } else if (scene.objects[id].used && (scene.objects[id].object.mask & query.mask) != 0 && !excluded(query, id)) {
      const Object& object = scene.objects[id].object;
      addRange(plan.others, id,
               frameFromRecentred(plan.axes, origin, object.worldFromMesh, scene.meshes[object.mesh].centre));
    }
  }
  return plan;
}

}  // namespace radar
