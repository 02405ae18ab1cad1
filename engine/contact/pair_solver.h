// Solves the pairs of triangles that may be first, as a search or pixels propose them, and decides the answers.
// Recorded into any command buffer; owns its buffers.
#pragma once

#include <functional>
#include <span>

#include "gpu/kernel.h"
#include "scene/gpu_scene.h"
#include "shaders/contact/interop.h"

namespace radar {

using OpenStage = std::function<void(const char*)>;

class PairSolver {
 public:
  PairSolver(const gpu::Owner& owner, GpuScene& scene);

  /// Every program that one may run on the device.
  static std::vector<gpu::Program> programs(const Device::Impl& device);

  /// Makes room, in `unresolved` at most as the device allows; all of a search's unresolved pairs are listed, or none.
  void reserve(uint32_t searches, uint32_t results, uint32_t pairs, uint32_t unresolved);
  /// Begins a recording of so many searches, and stages its counts.
  void begin(uint32_t searches, gpu::Upload& upload);

  /// Before pairs are proposed: empties the searches' lists of them.
  void recordReset(const gpu::Commands& commands);
  /// Records the answers from the refined pairs, which are none for searches that are unfinished. The caller
  /// records the barriers before and after. `pairs`: an invocation of kContactGroup for each of them. `areCertified`:
  /// certify.comp comes first, and leaves some to refine.comp; else all have been left to it.
  void record(const gpu::Commands& commands, const OpenStage& stage, const gpu::Groups& pairs, bool areCertified,
              bool ignoresLeaving);

  struct Lists {
    gpu::Array<gpu::Sweep> sweeps;
    gpu::Array<gpu::SearchState> states;
    gpu::Array<gpu::RefinedPair> refinedPairs;
    gpu::Array<gpu::SearchCounts> counts;
    gpu::Array<Result> results;
  };
  const Lists& lists() const { return lists_; }
  /// The unresolved pairs, in host memory. Valid until the device works again.
  std::span<const gpu::UnresolvedPair> unresolved(const gpu::SearchCounts& counts) const;
  /// Of the recording begun last; never 0.
  uint32_t serial() const { return serial_; }
  uint32_t unresolvedRoom() const { return unresolvedRoom_; }

  /// Where the results begin in a readback of counts, then results.
  static constexpr VkDeviceSize kFirstResult = gpu::roundedUp(sizeof(gpu::SearchCounts), alignof(Result));

 private:
  const Device::Impl* device_;
  GpuScene& scene_;
  gpu::Passes run_;
  Lists lists_;
  gpu::Array<uint32_t> heads_;
  gpu::Array<gpu::UnresolvedPair> unresolved_;  ///< in host memory: rarely used
  uint32_t searchCount_ = 0, unresolvedRoom_ = 0, serial_ = 0;
};

}  // namespace radar
