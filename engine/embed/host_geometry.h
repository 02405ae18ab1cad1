// What lies in a host's buffers comes into a recorder's copy of the scene, in the host's command buffer: vertices that
// it deforms, and objects that it moves. Keeps a copy of what it is given.
#pragma once

#include <map>
#include <span>

#include "gpu/kernel.h"
#include "radar/host_geometry.h"
#include "scene/gpu_scene.h"

namespace radar {

/// Empty if `geometry` keeps its contracts.
std::string whatIsWrong(const HostGeometry& geometry, const Scene& scene);

class HostGeometryPass {
 public:
  HostGeometryPass(const Device::Impl& device, const GpuScene& resident);

  /// Takes note of it and makes room, while the device is idle; throws where it does not fit the device.
  void stage(const HostGeometry& geometry, const Scene::Impl& scene);
  bool empty() const { return meshes_.empty() && moved_.empty(); }
  GpuScene::Overwritten overwritten() const;
  /// Behind the upload of the scene; all of it is ready for compute shaders then.
  void record(const gpu::Commands& commands);
  /// Behind the answers: refuses them where something has strayed. A barrier from compute shaders to what reads them
  /// comes next.
  void recordRefusal(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t count);
  /// Something that has strayed, in words, once the device is done; empty: nothing.
  std::string stray() const;

 private:
  struct Deformed {
    MeshId mesh;
    uint32_t vertices, firstByte, stride, component;
  };
  struct Source {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  /// The nodes of a mesh that are refitted together: those of one depth.
  struct Level {
    MeshId mesh;
    uint32_t first, count;  ///< into the list of nodes
  };
  uint32_t copyFrom(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes);
  void addMoved(const MovedObjects& objects, const Scene::Impl& scene);
  void listNodes(const Scene::Impl& scene);
  void setArguments();

  const Device::Impl* device_;
  const GpuScene& resident_;
  gpu::KernelArguments deform_, refit_, move_, refuse_;
  gpu::Upload upload_;
  gpu::Array<uint32_t> words_, refitNodes_;
  gpu::Array<gpu::Moved> movedBuffer_;
  gpu::Array<gpu::Stray> stray_;  ///< on the host: hardly ever is there any
  std::vector<Source> sources_;
  VkDeviceSize copied_ = 0;  ///< bytes, of all sources
  std::vector<Deformed> meshes_;
  std::vector<gpu::Moved> moved_;
  std::vector<uint32_t> nodeList_;
  std::vector<std::vector<Level>> levels_;  ///< of all meshes; the deepest last
  std::vector<uint64_t> listed_;            ///< versions of the meshes whose nodes are listed
};

}  // namespace radar
