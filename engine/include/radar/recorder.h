// Searches recorded into a host's own command buffers, whose answers stay on the device.
//
// The engine submits nothing and waits for nothing here: HostDevice::queue may be null. radar/result.glsl is the
// answers' layout for shaders.
#pragma once

#include "radar/host_geometry.h"

namespace radar {

/// Room for what is recorded at a time: nothing is done again with more. A query that exceeds a limit becomes
/// Status::invalid with the flag named; other queries are unaffected, unless they share what ran out.
struct Capacity {
  uint32_t queries = 64;  ///< more make record() throw
  /// Pairs of triangles that may be first as far as floats can tell, of all queries together, while the search goes on:
  /// some 10 a query among boxes, 30 among meshes, hundreds where shapes interlock. kFlagCandidates.
  uint32_t candidates = 1u << 14;
  /// Dispatches that the search is cut into, each of a few milliseconds at most; those behind the last one that is
  /// needed cost next to nothing. An even number up to 64: kFlagRounds.
  uint32_t rounds = 16;
  /// Pairs of triangles left open, in all. Where a query's have no room, read() cannot decide them: kFlagOpen stays.
  uint32_t openPairs = 1u << 12;
};

/// Records batches of mode contact. The host makes one for each of its frames in flight, while loading: each has a copy
/// of the scene on the device and its own lists; pipelines are the device's, made with the first of them. It, and the
/// Device, stay until what it recorded has been executed: destructors do not wait.
class RADAR_API Recorder {
 public:
  /// `device` and `scene` outlive it. Throws where the device's buffers cannot hold `capacity`, naming the member.
  Recorder(const Device& device, const Scene& scene, const Capacity& capacity = {});
  ~Recorder();
  Recorder(Recorder&&) noexcept;
  Recorder& operator=(Recorder&&) noexcept;

  /// Records the search into `commands`, a primary or secondary command buffer of HostDevice::queueFamily in the
  /// recording state, outside a render pass. Reads `scene`, `queries` and `geometry` here and not later, the host's
  /// buffers that `geometry` names when the commands are executed. Query i's answer goes to results(),
  /// i * sizeof(Result) bytes from its start: to the bit that of Sweeper::run, except where the flag kFlagOpen says
  /// that pairs are too close for the device: then the status is undecided, `hi` does not exist, and nothing meets
  /// before `lo`. Queries whose numbers floats cannot hold are Status::invalid with
  /// kFlagRange:
  /// - coordinates beyond 2^80 (of one object, or its bounds: all queries) or more than 10^22 times the sensor's size;
  /// - sizes below 2^-80; sizes of sensor and object that differ by more than 10^12 times, also along an axis on which
  ///   a mesh is flat but its matrix is not; an object in reach that is more than 10^12 sensors away;
  /// - a distance D that is not 0 but below 2^-100 of the sensor's size, or 2^-138 of the scene's; there is no upper
  ///   end;
  /// - a direction whose components differ by more than about 2^1000 times.
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
  /// - Allocates device memory only where scene, geometry or the lists of excluded objects have grown since.
  ///
  /// Throws before it records anything if a query breaks its contract or is not of mode contact; if there are more than
  /// Capacity::queries; if `geometry` breaks its contract; and if something does not fit the device.
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
