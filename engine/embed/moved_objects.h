// Objects that a host moves, or whose meshes it deforms without bounds: their placements and, unless they have bounds,
// the tree over objects, computed on the device in the host's command buffer. What is listed for this on the CPU is
// kept while these objects and meshes stay the same.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contact/pass.h"
#include "gpu/kernel.h"
#include "radar/host.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

class MovedObjectsPass {
 public:
  MovedObjectsPass(const Device::Impl& device, const GpuScene& resident);

  /// Lists the objects of `groups`, and others that use one of `meshes`, while the device is idle. `firstBytes`: of
  /// each group's transforms, in the copied words. Throws if an object does not exist or is named twice.
  void stage(std::span<const MovedObjects> groups, std::span<const uint32_t> firstBytes, std::span<const MeshId> meshes,
             const Scene::Impl& scene);
  bool empty() const { return !isActive_; }
  /// Objects without bounds: only the device knows where they are. Ascending.
  std::span<const ObjectId> unbounded() const;
  std::shared_ptr<const GpuScene::Moved> overwritten() const { return isActive_ ? list_->overwritten : nullptr; }

  /// The caller records the barrier behind it.
  void recordUpload(const gpu::Commands& commands) const;
  /// Makes placements and leaves. The caller records the barrier before recordFit().
  void recordMove(const gpu::Commands& commands, const gpu::Array<uint32_t>& words,
                  const gpu::Array<gpu::BoundsViolation>& violation);
  /// Fits the nodes above those leaves, and makes them visible to compute shaders.
  void recordFit(const gpu::Commands& commands);
  /// Adapts the sensors that the CPU has encoded for `search` to where the objects are now, and makes them visible to
  /// compute shaders.
  void recordReach(const gpu::Commands& commands, const ContactPass& search);
  /// Marks what has been recorded as uploaded.
  void confirm() { isUploaded_ = isUploaded_ || isActive_; }
  /// Marks it as uncertain.
  void forget() { isUploaded_ = false; }
  /// Why an object of the last recording may violate its bounds.
  std::string describeViolation(ObjectId object) const;

 private:
  struct Group {
    uint32_t firstByte = 0;
    VkDeviceSize stride = 0;
    TransformLayout layout{};
    std::vector<ObjectId> objects{};
  };
  /// What depends on the groups and meshes, which objects there are, the tree's links and the bounds alone.
  struct List {
    std::vector<Group> groups;
    std::vector<MeshId> meshes;
    uint64_t scene, objects, structure, bounds;  ///< versions
    std::vector<gpu::Moved> moved;
    std::vector<ObjectId> unbounded;  ///< ascending
    std::shared_ptr<GpuScene::Moved> overwritten;
    std::vector<uint32_t> nodes, ends;  ///< inner nodes to fit, the root first, and where each depth of them ends
  };
  bool isListed(std::span<const MovedObjects> groups, std::span<const uint32_t> firstBytes,
                std::span<const MeshId> meshes, const Scene::Impl& scene) const;
  void addGroup(List& list, const MovedObjects& group, uint32_t firstByte, std::vector<bool>& isNamed,
                const Scene::Impl& scene) const;
  void addStanding(List& list, const std::vector<bool>& isNamed, const Scene::Impl& scene) const;
  void stageUpload(const List& list);

  const GpuScene& resident_;
  gpu::Passes run_;
  gpu::Upload upload_;
  gpu::Array<gpu::Moved> moved_;
  gpu::Array<uint32_t> fitNodes_;
  std::unique_ptr<const List> list_;  ///< null: none
  gpu::MovePush push_{};
  bool isActive_ = false, isUploaded_ = false;
};

}  // namespace radar
