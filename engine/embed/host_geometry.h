// Copies geometry from a host's buffers to a recorder's copy of the scene, in the host's command buffer: vertices that
// it deforms, and objects that it moves (moved_objects.h). Keeps a copy of its input.
#pragma once

#include <span>

#include "embed/moved_objects.h"
#include "embed/unbounded_meshes.h"
#include "gpu/kernel.h"
#include "radar/host.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

/// Empty if `geometry` is valid, but for the numbers of the objects.
std::string validate(const HostGeometry& geometry, const Scene& scene);

class HostGeometryPass {
 public:
  HostGeometryPass(const Device::Impl& device, const GpuScene& resident);

  /// Stores `geometry` and makes room for it, while the device is idle. Throws if it does not fit the device, or
  /// MovedObjectsPass::stage() does.
  void stage(const HostGeometry& geometry, const Scene::Impl& scene);
  bool empty() const { return meshes_.empty() && moved_.empty(); }
  /// Objects of which only the device knows where they are. Ascending.
  std::span<const ObjectId> unbounded() const { return moved_.unbounded(); }
  /// Whether only the device knows where a mesh's vertices are.
  bool isUnbounded(MeshId mesh) const { return unboundedMeshes_.contains(mesh); }
  /// Then stores the sensors that have such a mesh, perhaps none.
  void stageSensors(std::span<const gpu::DeformedSensor> sensors, const Scene::Impl& scene) {
    unboundedMeshes_.stageSensors(sensors, scene);
  }
  GpuScene::Overwritten overwritten() const;
  /// Call after recording the scene's upload. The geometry is then visible to compute shaders.
  void record(const gpu::Commands& commands, const Scene::Impl& scene);
  /// Then call it for a search whose sensors the CPU has encoded.
  void recordReach(const gpu::Commands& commands, const ContactPass& search) {
    unboundedMeshes_.recordPlace(commands, search);
    moved_.recordReach(commands, search);
  }
  /// Call after recording the answers: invalidates them if anything has left its bounds. The caller records the barrier
  /// from compute shaders to their readers.
  void recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t count);
  /// The caller records the barriers around it.
  void recordReadback(const gpu::Commands& commands) const { unboundedMeshes_.recordReadback(commands); }
  /// Boxes around the meshes' vertices of which only the device knows where they are, once it is done.
  std::map<MeshId, Box> unboundedBoxes() const { return unboundedMeshes_.boxes(); }
  /// Describes something that left its bounds, once the device is done; empty if nothing did.
  std::string boundsViolation() const;
  /// Marks what has been recorded as executed, unless forget() is called.
  void confirm() { moved_.confirm(); }
  void forget() { moved_.forget(); }

 private:
  struct Deformed {
    MeshId mesh;
    uint32_t vertices, firstHostVertex, firstByte, stride, component;
    uint32_t numbers;  ///< where `vertexNumbers_` has those of its vertices, less the first's; kNone: consecutive
    bool isBounded;
  };
  struct Source {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  /// Nodes of a mesh at one depth, refitted together.
  struct Level {
    MeshId mesh;
    uint32_t first, count;  ///< in the list of nodes
  };
  uint32_t copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes);
  void listNodes(const Scene::Impl& scene);

  const Device::Impl* device_;
  const GpuScene& resident_;
  gpu::Passes run_;
  gpu::Upload upload_;
  gpu::Array<uint32_t> words_, refitNodes_, numbers_;
  gpu::Array<gpu::BoundsViolation> violation_;  ///< in host memory: rarely written
  std::vector<Source> sources_;
  VkDeviceSize copied_ = 0;  ///< bytes, over all sources
  std::vector<Deformed> meshes_;
  std::vector<uint32_t> vertexNumbers_;
  UnboundedMeshesPass unboundedMeshes_;
  MovedObjectsPass moved_;
  std::vector<uint32_t> nodeList_;
  std::vector<std::vector<Level>> levels_;  ///< over all meshes; the deepest last
  std::vector<uint64_t> listed_;            ///< versions of the meshes whose nodes are listed
};

}  // namespace radar
