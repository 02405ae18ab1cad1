#include "sweep/encode.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace radar {

namespace {

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

uint32_t pixelsAcross(const SensorWindow& window, int axis, double pixel, uint32_t resolution) {
  const double pixels = std::ceil((window.box.hi[axis] - window.box.lo[axis]) / pixel);
  return std::clamp(static_cast<uint32_t>(pixels), 1u, resolution);
}

void fillView(gpu::View& view, const Query& query, const SensorWindow& window, const Reach& reach, const ViewPlan& plan,
              uint32_t resolution) {
  // The far plane lies a little behind what must be seen, so that contact exactly at D is not cut off.
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
  view.rangeLimit = static_cast<float>((plan.d + reach.error + window.error) / rangeScale + 4 * kFloatUnit);
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
  const Reach reach = reachOf(query, scene, hierarchy, window);
  fillView(plan.view, query, window, reach, plan, resolution);

  // The scales as the shaders see them, rounded to float: pictures and what is read from them agree.
  const double backPlane = window.box.lo[2];
  const double rangeScale = plan.view.rangeScale, maskScale = plan.view.maskScale, maskBase = plan.view.maskBase;
  const auto place = [&](ObjectId object, MeshId mesh, const Affine& m, double error, double scaleZ, double offsetZ) {
    const double snap =
        std::ldexp(1.0, -static_cast<int>(subPixelBits)) + error / plan.pixel + 6 * kFloatUnit * resolution;
    return Placed{object, mesh, clipFrom(m, window.box, plan.pixel, resolution, scaleZ, offsetZ),
                  static_cast<float>(snap), static_cast<float>(error * std::abs(scaleZ) + 8 * kFloatUnit)};
  };
  plan.mask =
      place(kNone, query.mesh, window.frameFromMesh, window.error, -1 / maskScale, (maskBase + backPlane) / maskScale);
  if (reach.objects.empty()) return plan;
  const auto addRange = [&](std::vector<Placed>& to, ObjectId id, const Affine& m, double error) {
    const MeshId mesh = scene.objects[id].object.mesh;
    to.push_back(place(id, mesh, m, error, 1 / rangeScale, -backPlane / rangeScale));
    plan.triangles += scene.meshes[mesh].triangleCount();
  };
  plan.triangles += sensor.triangleCount();
  for (const Reached& r : reach.objects) addRange(plan.inReach, r.object, r.frameFromMesh, r.error);
  if (select) return plan;
  Box seen = window.box;
  seen.hi[2] = backPlane + rangeScale;
  auto next = reach.objects.begin();
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (next != reach.objects.end() && next->object == id) {
      ++next;
    } else if (const Object& object = scene.objects[id].object;
               scene.objects[id].used && !isExcluded(query, object, id)) {
      const Mesh& mesh = scene.meshes[object.mesh];
      const Affine m = frameFromRecentred(plan.axes, window.origin, object.worldFromMesh, mesh.centre);
      const double error = placementError(mesh, m);
      // The pictures reach a rounding farther than select does; what lies in between must not make a difference.
      if (!overlap(boxOfRecentred(mesh, m), seen, 2 * error)) addRange(plan.others, id, m, error);
    }
  }
  return plan;
}

}  // namespace radar
