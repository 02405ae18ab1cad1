// Searches recorded into a host's own command buffers, whose answers stay on the device.
//
// The engine submits nothing and waits for nothing here: HostDevice::queue may be null. radar/result.glsl is the
// answers' layout for shaders.
#pragma once

#include "radar/host_geometry.h"

namespace radar {

/// Room for what is recorded at a time: nothing is done again with more. What goes beyond leaves its query
/// Status::invalid with the flag named, and no other.
struct Capacity {
  uint32_t queries = 64;  ///< more make record() throw
  /// Clusters, of at most 64 triangles, of sensors and of what is in their reach, in all: kFlagClusters. What a host
  /// deforms or moves counts whole where its bounds are in reach.
  uint32_t clusters = 1u << 14;
  /// Pairs of a sensor's cluster and a scene's whose boxes can meet, in all: kFlagClusterPairs.
  uint32_t clusterPairs = 1u << 18;
  /// Pairs of triangles that may be first, or have been, of each query: kFlagContenders.
  uint32_t contenders = 256;
  /// Dispatches that a search may take; one that has ended costs the next ones next to nothing: kFlagDispatches.
  uint32_t dispatches = 6;
  /// Pairs of triangles left open, in all. Where there are more, read() decides none: kFlagOpen stays.
  uint32_t openPairs = 1u << 12;
};

/// Records batches of mode contact. The host makes one for each of its frames in flight, while loading: each has a copy
/// of the scene on the device, its own lists, and pipelines from HostDevice::pipelineCache.
class RADAR_API Recorder {
 public:
  /// `device` and `scene` outlive it. Throws where the device's buffers cannot hold `capacity`, naming the member.
  Recorder(const Device& device, const Scene& scene, const Capacity& capacity = {});
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// What recording `queries` now would take: queries, clusters and clusterPairs (an upper bound) are computed, the
  /// other members are the defaults. Throws as record() does if a query cannot be recorded.
  Capacity need(std::span<const Query> queries);

  /// Records the search into `commands`, a primary or secondary command buffer of HostDevice::queueFamily in the
  /// recording state, outside a render pass. Reads `scene`, `queries` and `geometry` here and not later, the host's
  /// buffers that `geometry` names when the commands are executed. Query i's answer goes to results(),
  /// i * sizeof(Result) bytes from its start: to the bit that of Sweeper::run, except where the flag kFlagOpen says
  /// that pairs are too close for the device: then the status is undecided, `hi` does not exist, and nothing meets
  /// before `lo`.
  ///
  /// Where something in the host's buffers is out of its bounds, or not finite, every answer is Status::invalid with
  /// kFlagBounds.
  ///
  /// - Before: what this object recorded before has been executed and waited for. What wrote the buffers of `geometry`
  ///   is visible to VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT; whatever writes them next waits for
  ///   that stage. Without them nothing needs to be made visible.
  /// - Afterwards: the commands are submitted once or never; if never, reset() comes before the next record(). Whoever
  ///   reads the answers waits for VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT.
  /// - Disturbed: the bound compute pipeline, descriptor set 0 of the compute bind point, and push constants.
  /// - Allocates device memory only where scene or geometry have grown since the last call.
  ///
  /// Throws before it records anything if a query breaks its contract, is not of mode contact, or has a tolerance; if
  /// there are more than Capacity::queries; if `geometry` breaks its contract; and if something does not fit the
  /// device.
  void record(VkCommandBuffer commands, std::span<const Query> queries, const HostGeometry& geometry = {});
  /// What was recorded last has not been executed and will not be.
  void reset();

  /// The answers, on the device: made once, for storage and transfer; stays the engine's.
  VkBuffer results() const;

  /// The answers on the CPU, with what was open decided, once what was recorded last has been executed and waited for
  /// (by a fence, or a semaphore's wait on the host): does not wait itself. As many as queries were recorded. May come
  /// late: what has changed in the scene since does not matter.
  std::vector<Result> read();
  /// Where kFlagBounds is set: something that has left its bounds, in words; else empty. When read() may be called.
  std::string stray() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
