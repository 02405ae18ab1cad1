// The tree over objects of which a host moves some. Its parts, the leaves of moved objects and the largest subtrees in
// which nothing moves, are sorted in space on the device, and a tree is built above them, in the host's command buffer
// (docs/method.md, "A host's geometry").
#pragma once

#include <span>

#include "gpu/kernel.h"
#include "shaders/embed/interop.h"

namespace radar {

class MovedTree {
 public:
  explicit MovedTree(const gpu::Owner& owner);

  /// Nodes that it builds, behind those of the scene's tree: all but the root.
  static uint32_t nodesAbove(size_t parts) { return parts < 2 ? 0 : static_cast<uint32_t>(2 * (parts - 1)); }

  /// Takes the parts, by their nodes, while the device is idle, and stages them. They are sorted in the next recording.
  void stage(std::span<const uint32_t> parts, gpu::Upload& upload);
  /// Begins a recording; see gpu::Passes.
  void begin() { run_.begin(); }
  /// Records the fills; the caller records the barrier behind them.
  void recordFills(const gpu::Commands& commands) const;
  /// Records the building in `nodes`, whose leaves are fitted, from node `first` on; the root becomes node 0. The parts
  /// are sorted if that pays for so many searches, else they keep their order. The barriers around it are the caller's.
  void record(const gpu::Commands& commands, const gpu::Array<gpu::ObjectNode>& nodes, uint32_t first,
              uint32_t searches);

 private:
  void sort(const gpu::Commands& commands, const gpu::Array<gpu::ObjectNode>& nodes);
  gpu::Array<gpu::Part>& sorted() { return sorted_[sortedAt_]; }

  gpu::Passes run_;
  gpu::Array<uint32_t> parts_, reached_;
  gpu::Array<gpu::Part> sorted_[2];
  gpu::Array<gpu::Extent> extent_;
  uint32_t count_ = 0;     ///< of parts
  uint32_t sortedAt_ = 0;  ///< which of the two has the sorted ones
  uint64_t paid_ = 0;      ///< parts whose sorting has been earned since they were sorted
};

}  // namespace radar
