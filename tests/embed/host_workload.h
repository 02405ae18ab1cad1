// A workload of which a host deforms meshes and moves objects in buffers of its own.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deque>
#include <random>
#include <span>
#include <vector>

#include "embed/on_device.h"
#include "radar/recorder.h"
#include "workloads/workload.h"

namespace radar::test {

/// The smallest bounds of the vertices.
inline Bounds boundsOf(std::span<const float> positions) {
  Bounds bounds{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
  for (size_t i = 0; i < positions.size(); ++i) {
    bounds.lo[i % 3] = std::min(bounds.lo[i % 3], double{positions[i]});
    bounds.hi[i % 3] = std::max(bounds.hi[i % 3], double{positions[i]});
  }
  return bounds;
}

/// The bounds of a placed box.
inline Bounds placedBounds(const Bounds& box, const Transform& pose) {
  Bounds out;
  for (int k = 0; k < 3; ++k) {
    const double* r = &pose.m[4 * static_cast<size_t>(k)];
    double middle = r[3], half = 0;
    for (size_t j = 0; j < 3; ++j) {
      middle += r[j] * 0.5 * (box.lo[j] + box.hi[j]);
      half += std::abs(r[j]) * 0.5 * (box.hi[j] - box.lo[j]);
    }
    out.lo[static_cast<size_t>(k)] = middle - half;
    out.hi[static_cast<size_t>(k)] = middle + half;
  }
  return out;
}

/// A workload whose geometry lies in a host's buffers; the scene knows only rest poses, and bounds of some.
class HostWorkload {
 public:
  /// Rounds the poses of what moves in `truth` to floats. About two thirds of the meshes and half of the objects become
  /// the host's; if `mayBound`, some with bounds.
  HostWorkload(tools::Workload& truth, uint32_t seed, Scene& to, bool mayBound = true)
      : scene(to), truth_(truth), random_(seed), mayBound_(mayBound) {
    tools::replaceBy({.scenes = {{}}}, 0, scene);
    for (const tools::MeshData& mesh : truth.meshes) addMesh(mesh);
    for (tools::Instance& instance : truth.scenes[0].instances) addObject(instance);
    transforms_.emplace_back(transformBytes_);
    moved_.push_back({.transforms = transforms_[0].get(), .first = 16, .stride = 64, .objects = movedIds_});
  }
  HostGeometry geometry() const {
    if (movedIds_.empty()) return {.meshes = deformed_};
    return {.meshes = deformed_, .objects = moved_};
  }

  Scene& scene;

 private:
  double uniform(double lo, double hi) { return lo + (hi - lo) * static_cast<double>(random_() >> 8) * 0x1p-24; }

  void addMesh(const tools::MeshData& mesh) {
    if (random_() % 3 == 0) {
      scene.addMesh(mesh.positions, mesh.indices);
      return;
    }
    const Bounds bounds = boundsOf(mesh.positions);
    std::vector<float> rest = mesh.positions;
    const bool near = random_() % 2 == 0, isBounded = mayBound_ && random_() % 2 == 0;
    // Without bounds, the rest pose may have any size and be elsewhere.
    const double scale = isBounded ? 1 : std::exp2(uniform(-4, 4)), away = isBounded ? 0 : uniform(-3, 3);
    for (size_t i = 0; i < rest.size(); ++i) {
      const double lo = bounds.lo[i % 3], hi = bounds.hi[i % 3];
      const double value = near ? rest[i] + 0.05 * uniform(lo - hi, hi - lo) : uniform(lo, hi);
      rest[i] = static_cast<float>(std::clamp(value, lo, hi) * scale + away * (hi - lo));
    }
    const MeshId id = isBounded ? scene.addMesh(rest, mesh.indices, bounds) : scene.addMesh(rest, mesh.indices);
    const size_t first = random_() % 8, stride = 12 + random_() % 9;
    std::vector<std::byte> bytes(first + stride * mesh.vertexCount() + 12);
    for (size_t v = 0; v < mesh.vertexCount(); ++v) {
      std::memcpy(&bytes[first + stride * v], &mesh.positions[3 * v], 12);
    }
    vertices_.emplace_back(bytes);
    deformed_.push_back({id, {.buffer = vertices_.back().get(), .first = first, .stride = stride}});
  }

  void addObject(tools::Instance& instance) {
    const bool moves = random_() % 2 == 0;
    for (double& value : instance.worldFromMesh.m) {
      if (moves) value = static_cast<float>(value);
    }
    Object object{instance.mesh, instance.worldFromMesh, ~0u};
    if (moves) object.worldFromMesh.m[3] += 1;
    const ObjectId id = scene.addObject(object);
    if (!moves) return;
    const Bounds box = boundsOf(truth_.meshes[instance.mesh].positions);
    Bounds bounds = placedBounds(box, instance.worldFromMesh);
    // Room for the rounding of float arithmetic on a mesh far from its origin.
    double magnitude = 0;
    for (size_t i = 0; i < 12; ++i) {
      const double column = i % 4 == 3 ? 1 : std::abs(box.lo[i % 4]) + std::abs(box.hi[i % 4]);
      magnitude = std::max(magnitude, std::abs(instance.worldFromMesh.m[i]) * column);
    }
    const double room = 1e-5 * magnitude + (random_() % 2 == 0 ? 0 : 0.5 * (bounds.hi[0] - bounds.lo[0]));
    for (size_t k = 0; k < 3; ++k) {
      bounds.lo[k] -= room;
      bounds.hi[k] += room;
    }
    if (mayBound_ && random_() % 3 != 0) scene.setBounds(id, bounds);
    if (movedIds_.empty()) transformBytes_.resize(16);
    transformBytes_.resize(16 + 64 * movedIds_.size());
    for (const double value : instance.worldFromMesh.m) append<float>(transformBytes_, {static_cast<float>(value)});
    movedIds_.push_back(id);
  }

  const tools::Workload& truth_;
  std::mt19937 random_;
  bool mayBound_;
  std::deque<OnDevice> vertices_, transforms_;
  std::vector<std::byte> transformBytes_ = std::vector<std::byte>(16);
  std::vector<ObjectId> movedIds_;
  std::vector<DeformedMesh> deformed_;
  std::vector<MovedObjects> moved_;
};

}  // namespace radar::test
