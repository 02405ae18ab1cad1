#include "embed/moved_tree.h"

#include "gpu/barrier.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

// To sort a part takes a small share of a search's time, and of the time in which an object is moved: so each search
// pays for so many parts, and so many recordings, whatever they search, for all.
constexpr uint64_t kPartsPerSearch = 4, kRecordings = 16;

constexpr VkBufferUsageFlags kFilled = VK_BUFFER_USAGE_TRANSFER_DST_BIT;

}  // namespace

MovedTree::MovedTree(const gpu::Owner& owner)
    : run_(owner, {shaders::kCentres, shaders::kCode, shaders::kSort, shaders::kSort, shaders::kFit}),
      parts_(owner, "parts of the tree over objects", BufferDomain::device, kFilled),
      reached_(owner, "reached nodes", BufferDomain::device, kFilled),
      sorted_{{owner, "sorted parts", BufferDomain::device}, {owner, "other sorted parts", BufferDomain::device}},
      extent_(owner, "extent of parts", BufferDomain::device, kFilled) {}

void MovedTree::stage(std::span<const uint32_t> parts, gpu::Upload& upload) {
  count_ = static_cast<uint32_t>(parts.size());
  paid_ = count_;
  if (count_ < 2) return;
  parts_.reserve(count_);
  reached_.reserve(count_);
  for (gpu::Array<gpu::Part>& sorted : sorted_) sorted.reserve(count_);
  extent_.reserve(1);
  upload.add(parts.data(), parts.size_bytes(), parts_);
}

void MovedTree::recordFills(const gpu::Commands& commands) const {
  if (count_ < 2) return;
  commands->CmdFillBuffer(commands, reached_.get(), 0, count_ * sizeof(uint32_t), gpu::kNobody);
  commands->CmdFillBuffer(commands, extent_.get(), 0, sizeof(gpu::Extent), gpu::kNobody);
}

void MovedTree::record(const gpu::Commands& commands, const gpu::Array<gpu::ObjectNode>& nodes, uint32_t first,
                       uint32_t searches) {
  if (count_ < 2) return;
  paid_ += kPartsPerSearch * searches + (count_ + kRecordings - 1) / kRecordings;
  if (paid_ >= count_) sort(commands, nodes);
  run_(commands, shaders::kFit, gpu::groupsFor(count_, gpu::kHostGroup), gpu::FitPush{count_, first},
       {{gpu::kSlotObjectNodes, nodes}, {gpu::kSlotSorted, sorted()}, {gpu::kSlotReached, reached_}});
}

void MovedTree::sort(const gpu::Commands& commands, const gpu::Array<gpu::ObjectNode>& nodes) {
  using namespace gpu;  // the slots
  const uint32_t groups = groupsFor(count_, kHostGroup);
  paid_ = 0;
  sortedAt_ = 0;
  run_(commands, shaders::kCentres, groups, PartsPush{count_},
       {{kSlotObjectNodes, nodes}, {kSlotParts, parts_}, {kSlotExtents, extent_}});
  computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kCode, groups, PartsPush{count_},
       {{kSlotObjectNodes, nodes}, {kSlotParts, parts_}, {kSlotExtents, extent_}, {kSlotSorted, sorted()}});
  computeWriteToComputeReadWrite(commands);
  for (uint64_t run = 1; run < count_; run *= kSortRuns) {
    const Array<Part>& unsorted = sorted();
    sortedAt_ = 1 - sortedAt_;
    run_(commands, shaders::kSort, groups, SortPush{count_, static_cast<uint32_t>(run)},
         {{kSlotUnsorted, unsorted}, {kSlotSorted, sorted()}});
    computeWriteToComputeReadWrite(commands);
  }
}

}  // namespace radar
