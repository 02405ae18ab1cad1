// What lies in a host's buffers comes into a recorder's copy of the scene, in the host's command buffer: vertices that
// it deforms, and objects that it moves. Owns its pipelines, and a copy of what it is given.
#pragma once

#include <span>

#include "gpu/pipeline.h"
#include "radar/host_geometry.h"
#include "sweep/contact_plan.h"
#include "sweep/resident_scene.h"

namespace radar {

/// Empty if `geometry` keeps its contracts.
std::string whatIsWrong(const HostGeometry& geometry, const Scene& scene);

class HostGeometryPass {
 public:
  HostGeometryPass(const Device::Impl& device, const ResidentScene& resident);

  /// Takes note of it and makes room, while the device is idle; throws where it does not fit the device.
  void stage(const HostGeometry& geometry, const Scene::Impl& scene);
  bool empty() const { return meshes_.empty() && moved_.empty(); }
  ResidentScene::Overwritten overwritten() const;
  /// Tells the placements of moved objects so.
  void prepare(ContactPlan& plan) const;
  /// Behind the upload of scene and placements; all of it is ready for compute shaders then. `results`: of
  /// recordRefusal.
  void record(const gpu::Commands& commands, const gpu::Buffer& placements, uint32_t placementCount,
              const gpu::Buffer& results);
  /// Behind the answers: refuses them where something has strayed. A barrier from compute shaders to what reads them
  /// comes next.
  void recordRefusal(const gpu::Commands& commands, uint32_t count);
  /// Something that has strayed, in words, once the device is done; empty: nothing.
  std::string stray() const;

 private:
  struct Deformed {
    MeshId mesh;
    uint32_t vertices, nodes, firstByte, stride, component;
  };
  struct Source {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  uint32_t copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes);
  void addMoved(const MovedObjects& objects, const Scene::Impl& scene);

  const Device::Impl* device_;
  const ResidentScene& resident_;
  gpu::Bindings bindings_;
  gpu::Pipeline deform_, refit_, move_, refuse_;
  gpu::Upload upload_;
  gpu::Buffer words_, movedBuffer_;
  gpu::Buffer stray_;  ///< on the host: hardly ever is there any
  std::vector<Source> sources_;
  VkDeviceSize copied_ = 0;  ///< bytes, of all sources
  std::vector<Deformed> meshes_;
  std::vector<gpu::Moved> moved_;
  std::vector<Box> bounds_;           ///< of each moved
  std::vector<uint32_t> movedIndex_;  ///< of each object id; kNone: not moved
};

}  // namespace radar
