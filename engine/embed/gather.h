// Merges the answers of a recording's searches past one object each on the device. On the CPU, once open ones are
// decided, query/hits.h does.
#pragma once

#include <span>

#include "gpu/array.h"
#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "radar/answers.h"
#include "shaders/embed/interop.h"

namespace radar {

class GatherPass {
 public:
  /// Makes room for this many searches.
  GatherPass(const Device::Impl& device, uint32_t searches);

  bool empty() const { return searches_.empty(); }
  /// Stages the searches of these queries, in their order.
  void stage(std::span<const gpu::Gathered> queries);
  /// The caller records the barrier behind it.
  void recordUpload(const gpu::Commands& commands) const { upload_.record(commands); }
  /// Call after recording the searches, which the shader waits for. `first`: index of the first search's answer. The
  /// caller records the barrier from compute shaders to their readers.
  void record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first);

 private:
  std::vector<gpu::Gathered> searches_;
  gpu::Upload upload_;
  gpu::Array<gpu::Gathered> buffer_;
  gpu::Passes run_;
};

}  // namespace radar
