#include "sampled/selection.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "query/swept.h"

namespace radar {

namespace {

// Bound on the double-precision error of a vertex in the frame, relative to `transformPoint`, world units.
double doubleError(const Mesh& mesh, const Transform& pose, const Vector& origin) {
  double worst = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &pose.m[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * (std::abs(mesh.origin[k]) + mesh.reach[k]);
    worst = std::max(worst, sum);
  }
  return 0x1p-47 * (worst + largest(origin));
}

// A box in the frame around a box in the world.
Box turnedBox(const Box& world, const std::array<Vector, 3>& axes, const Vector& origin) {
  Vector centre, half;
  for (int k = 0; k < 3; ++k) {
    centre[k] = 0.5 * (world.lo[k] + world.hi[k]) - origin[k];
    half[k] = 0.5 * (world.hi[k] - world.lo[k]);
  }
  Box box;
  for (int row = 0; row < 3; ++row) {
    const double middle = dot(axes[row], centre);
    double reach = doubleErrorWithin(world, origin);
    for (int k = 0; k < 3; ++k) reach += std::abs(axes[row][k]) * half[k];
    box.lo[row] = middle - reach;
    box.hi[row] = middle + reach;
  }
  return box;
}

// The box of the vertices in the frame, which is tighter than the mesh's box in the frame, so that M fills the window.
Box tightBox(const Mesh& mesh, const Affine& m) {
  Box box;
  for (int row = 0; row < 3; ++row) {
    const auto x = static_cast<float>(m[4 * row]), y = static_cast<float>(m[4 * row + 1]),
               z = static_cast<float>(m[4 * row + 2]);
    const float *px = mesh.local[0].data(), *py = mesh.local[1].data(), *pz = mesh.local[2].data();
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

// Objects in the swept prism, by id.
std::vector<SelectedObject> collectReached(const Query& query, const Scene::Impl& scene, const Prism& prism,
                                           double& farthest) {
  thread_local std::vector<ObjectId> ids;
  ids.clear();
  selectObjects(scene, prism, ids);
  std::sort(ids.begin(), ids.end());
  std::vector<SelectedObject> reached;
  for (ObjectId id : ids) {
    const Object& object = scene.objects[id].object;
    if (!takesPart(query, scene, id)) continue;
    const Mesh& mesh = scene.meshes[object.mesh];
    const Affine m = frameFromLocal(prism.axes, prism.origin, object.worldFromMesh, mesh.origin);
    Box box = boxOfLocal(mesh, m);
    const Box* bounds = scene.boundsOf(id);
    if (bounds != nullptr) box.merge(turnedBox(*bounds, prism.axes, prism.origin));
    const double error = doubleError(mesh, object.worldFromMesh, prism.origin);
    if (!overlap(box, prism.box, error)) continue;
    farthest = std::max(farthest, box.hi[2]);
    const double total = error + placementError(mesh, m);
    for (int k = 0; k < 3; ++k) {
      box.lo[k] -= total;
      box.hi[k] += total;
    }
    reached.push_back({id, m, total, box});
  }
  return reached;
}

}  // namespace

bool fitsFloats(const Mesh& mesh, const Affine& frameFromMesh) {
  constexpr double kMost = 0x1p125;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromMesh[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * std::max(1.0f, mesh.reach[k]);
    if (!(sum < kMost)) return false;
  }
  return true;
}

double placementError(const Mesh& mesh, const Affine& frameFromMesh) {
  // The 2^-120 terms cover floats below the normal range: of a product, of an entry per unit of the mesh, of a vertex.
  const double extent = mesh.reach[0] + double{mesh.reach[1]} + mesh.reach[2];
  double worst = 0, scale = 0;
  for (int row = 0; row < 3; ++row) {
    const double* r = &frameFromMesh[4 * row];
    double sum = std::abs(r[3]);
    for (int k = 0; k < 3; ++k) sum += std::abs(r[k]) * mesh.reach[k];
    worst = std::max(worst, sum);
    scale = std::max(scale, std::abs(r[0]) + std::abs(r[1]) + std::abs(r[2]));
  }
  return 16 * kFloatUnit * worst + 0x1p-120 * (1 + extent + scale);
}

double doubleErrorWithin(const Box& box, const Vector& origin) {
  return 0x1p-47 * (std::max(largest(box.lo), largest(box.hi)) + largest(origin));
}

SensorWindow lookAlong(const Query& query, const Mesh& sensor) {
  SensorWindow w;
  w.axes = axesAlong(query.direction);
  w.origin = transform(query.worldFromMesh, sensor.origin);
  w.frameFromMesh = frameFromLocal(w.axes, w.origin, query.worldFromMesh, sensor.origin);
  w.error = placementError(sensor, w.frameFromMesh) + doubleError(sensor, query.worldFromMesh, w.origin);
  const bool tight = !sensor.deforms && fitsFloats(sensor, w.frameFromMesh);
  w.box = tight ? tightBox(sensor, w.frameFromMesh) : boxOfLocal(sensor, w.frameFromMesh);
  w.length = w.box.hi[2] - w.box.lo[2];
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

Selection selectionOf(const Query& query, const Scene::Impl& scene, const SensorWindow& window) {
  Selection reach;
  const double d = window.length + query.distance;
  reach.prism = {window.origin, window.axes, window.box};
  Prism& prism = reach.prism;
  prism.box.hi[2] = window.box.lo[2] + d;
  for (int k = 0; k < 3; ++k) {
    prism.box.lo[k] -= window.error;
    prism.box.hi[k] += window.error;
  }
  double farthest = window.box.lo[2];
  reach.objects = collectReached(query, scene, prism, farthest);
  for (const SelectedObject& r : reach.objects) reach.error = std::max(reach.error, r.error);
  reach.depth = std::min(d, std::max(farthest - window.box.lo[2], 0.0));
  return reach;
}

}  // namespace radar
