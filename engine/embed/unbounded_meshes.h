// Meshes that a host deforms without having declared bounds: the device bounds their vertices, normalises them by that,
// and places the sensors that have such a mesh (docs/method.md, "A host's geometry").
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <vector>

#include "contact/pass.h"
#include "gpu/kernel.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

/// What the device needs to place the sensor with this number, which the CPU has encoded for its mesh as the scene has
/// it.
gpu::DeformedSensor deformedSensor(uint32_t sensor, const Query& query, const Motion& motion);

class UnboundedMeshesPass {
 public:
  UnboundedMeshesPass(const Device::Impl& device, const GpuScene& resident);

  /// Stores which meshes they are, while the device is idle.
  void stage(std::vector<MeshId> meshes);
  bool empty() const { return meshes_.empty(); }
  bool contains(MeshId mesh) const { return std::ranges::find(meshes_, mesh) != meshes_.end(); }
  std::span<const MeshId> meshes() const { return meshes_; }
  /// Then stores the sensors that have one of them, perhaps none.
  void stageSensors(std::span<const gpu::DeformedSensor> sensors, const Scene::Impl& scene);

  /// The caller records the barriers around it.
  void recordUpload(const gpu::Commands& commands) const;
  /// Describes the meshes by their vertices, and makes that visible to compute shaders.
  void recordBound(const gpu::Commands& commands, const Scene::Impl& scene);
  /// Places the sensors of `search`, and makes them visible to compute shaders.
  void recordPlace(const gpu::Commands& commands, const ContactPass& search);
  /// The caller records the barriers around it.
  void recordReadback(const gpu::Commands& commands) const;
  /// Boxes around the vertices that the triangles use, once the device is done.
  std::map<MeshId, Box> boxes() const;

 private:
  const GpuScene& resident_;
  gpu::Passes run_;
  gpu::Upload upload_;
  gpu::Array<uint32_t> unbounded_;
  gpu::Array<gpu::Extent> extents_, readback_;
  gpu::Array<gpu::DeformedSensor> sensors_;
  std::vector<MeshId> meshes_;
  gpu::PlacePush push_{};
};

}  // namespace radar
