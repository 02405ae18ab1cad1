// Copies geometry from a host's buffers to a recorder's copy of the scene, in the host's command buffer: vertices that
// it deforms, and objects that it moves (docs/method.md, "A host's geometry"). Keeps a copy of its input.
#pragma once

#include <algorithm>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "contact/pass.h"
#include "embed/geometry_list.h"
#include "embed/moved_tree.h"
#include "gpu/kernel.h"
#include "radar/host.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

/// Empty if `geometry` is valid, but for the numbers of the objects.
std::string validate(const HostGeometry& geometry, const Scene& scene);

class HostGeometryPass {
 public:
  HostGeometryPass(const gpu::Owner& owner, const GpuScene& resident);

  /// Stores valid `geometry` and makes room for it, while the device is idle. Throws Error if it does not fit the
  /// device, or if an object does not exist or is named twice.
  void stage(const HostGeometry& geometry, const Scene::Impl& scene);
  bool empty() const { return deformed_.meshes.empty() && moved_.moved.empty(); }
  /// Objects of which only the device knows where they are. Ascending.
  std::span<const ObjectId> unbounded() const { return moved_.unbounded; }
  /// Whether only the device knows where a mesh's vertices are.
  bool isUnbounded(MeshId mesh) const {
    return std::ranges::find(deformed_.unbounded, mesh) != deformed_.unbounded.end();
  }
  GpuScene::Overwritten overwritten() const;

  /// Call after recording the scene's upload. The geometry is then visible to compute shaders, of so many searches.
  void record(const gpu::Commands& commands, const Scene::Impl& scene, uint32_t searches);
  /// Call after recording the answers: invalidates them if anything has left its bounds. The caller records the barrier
  /// from compute shaders to their readers.
  void recordInvalidate(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t count);
  /// The caller records the barriers around it.
  void recordReadback(const gpu::Commands& commands) const;
  /// Boxes around the used vertices of unbounded meshes, once the device is done.
  std::map<MeshId, Box> unboundedBoxes() const;
  /// Describes something that left its bounds, once the device is done; empty if nothing did.
  std::string boundsViolation() const;
  /// Marks what has been recorded as executed, unless forget() is called.
  void confirm() { deformed_.isUploaded = moved_.isUploaded = true; }
  void forget() { deformed_.isUploaded = moved_.isUploaded = false; }

 private:
  struct Source {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  std::vector<uint32_t> copyFrom(const HostGeometry& geometry, const Scene::Impl& scene);
  void stageDeformed();
  void stageMoved();

  const Device::Impl* device_;
  const GpuScene& resident_;
  gpu::Passes run_;
  gpu::Upload upload_;
  gpu::Array<uint32_t> words_, unboundedMeshes_;
  gpu::Array<gpu::Deformed> deformedMeshes_;
  gpu::Array<gpu::RefitNode> refitNodes_;
  gpu::Array<gpu::Moved> movedObjects_;
  gpu::Array<gpu::Extent> extents_, readback_;
  gpu::Array<gpu::BoundsViolation> violation_;  ///< in host memory: rarely written
  std::vector<Source> sources_;                 ///< of `words_`
  DeformedList deformed_;
  MovedList moved_;
  MovedTree tree_;
};

}  // namespace radar
