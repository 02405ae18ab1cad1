// The mask of the contact tier: which triangles of a search that has become dear may still be first. Owns its pipelines
// and what it draws into.
#pragma once

#include <span>

#include "gpu/pipeline.h"
#include "sweep/resident_scene.h"

namespace radar {

class MaskRecorder {
 public:
  MaskRecorder(const Device::Impl& device, const ResidentScene& resident);

  /// What the contact tier lends: boxes are written anew for each cluster drawn, the others are read.
  struct Lent {
    const gpu::Buffer &targets, &placements, &refs, &boxes, &states;
  };
  /// One target's clusters: its ClusterRefs, those of the scene behind those of the sensor.
  struct Sides {
    uint32_t target, firstSensor, firstScene, end;
    uint32_t clusters() const { return end - firstSensor; }
  };
  /// Clusters that one record() may draw.
  static constexpr uint32_t kMostClusters = 1u << 16;

  /// Makes room for the masks of `sides`; returns the bytes that `upload` will stage. The device is idle.
  VkDeviceSize prepare(std::span<const Sides> sides);
  void upload(gpu::Upload& upload) const;
  /// Empties the scopes: before the upload's barrier, and one for what was filled.
  void clear(const gpu::Commands& commands) const;
  /// Behind these barriers; its own last one makes what it wrote ready for compute shaders.
  void record(const gpu::Commands& commands, const Lent& lent);

  /// kTilesPerCluster for each cluster drawn.
  const gpu::Buffer& tiles() const { return tiles_; }

 private:
  gpu::Pipeline pipeline(const char* name, uint32_t draws) const;
  void dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t first, uint32_t count) const;

  const Device::Impl* device_;
  const ResidentScene& resident_;
  gpu::Bindings bindings_;
  gpu::Pipeline drawFarthest_, drawSensor_, drawNearest_, markAlive_;
  gpu::Buffer items_, scopes_, tiles_;
  std::vector<gpu::MaskItem> itemList_;  ///< the scenes', then the sensors'
  uint32_t sceneItems_ = 0;
  uint32_t plane_ = 0;  ///< pixels of all targets
};

}  // namespace radar
