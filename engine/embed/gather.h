// Merges the answers of a recording's searches past one object each on the device. On the CPU, once open ones are
// decided, query/hits.h does.
#pragma once

#include <span>

#include "gpu/buffer.h"
#include "gpu/kernel.h"
#include "radar/answers.h"
#include "shaders/embed/interop.h"

namespace radar {

class GatherPass {
 public:
  /// Makes room for this many searches.
  GatherPass(const gpu::Owner& owner, uint32_t searches);

  bool empty() const { return queries_ == 0; }
  /// Stages these queries, whose searches follow one another.
  void stage(std::span<const gpu::Gathered> queries);
  /// The caller records the barrier behind it.
  void recordUpload(const gpu::Commands& commands) const { upload_.record(commands); }
  /// Call after recording the searches, which the shader waits for. `first`: index of the first search's answer. The
  /// caller records the barrier from compute shaders to their readers.
  void record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first);

 private:
  uint32_t queries_ = 0, searches_ = 0;
  gpu::Upload upload_;
  gpu::Array<gpu::Gathered> gathered_;
  gpu::Array<uint32_t> order_;
  gpu::Passes run_;
};

}  // namespace radar
