#include "embed/gather.h"

#include "gpu/barrier.h"
#include "gpu/device.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

GatherPass::GatherPass(const Device::Impl& device, uint32_t searches)
    : upload_(device),
      buffer_(device, "searches to gather", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      run_(device, {shaders::kGather}) {
  buffer_.reserve(searches);
  upload_.reserve(searches * sizeof(gpu::Gathered));
}

void GatherPass::stage(std::span<const gpu::Gathered> queries) {
  searches_.clear();
  for (const gpu::Gathered& query : queries) searches_.insert(searches_.end(), query.count, query);
  run_.begin();
  upload_.begin();
  upload_.add(searches_.data(), gpu::bytesOf(searches_), buffer_);
}

void GatherPass::record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first) {
  gpu::computeWriteToComputeReadWrite(commands);
  const auto count = static_cast<uint32_t>(searches_.size());
  run_(commands, shaders::kGather, gpu::groupsFor(count, gpu::kHostGroup), gpu::GatherPush{count, first},
       {{gpu::kSlotResults, results}, {gpu::kSlotGathered, buffer_}});
}

}  // namespace radar
