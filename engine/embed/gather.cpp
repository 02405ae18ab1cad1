#include "embed/gather.h"

#include "gpu/barrier.h"
#include "gpu/device.h"
#include "shaders/contact/interop.h"
#include "spirv/radar_shaders.h"

namespace radar {

GatherPass::GatherPass(const gpu::Owner& owner, uint32_t searches)
    : upload_(owner),
      gathered_(owner, "queries to gather", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      order_(owner, "order of searches", gpu::BufferDomain::device),
      run_(owner, {shaders::kGather}) {
  gathered_.reserve(searches);
  order_.reserve(VkDeviceSize{2} * searches);
  upload_.reserve(searches * sizeof(gpu::Gathered));
}

void GatherPass::stage(std::span<const gpu::Gathered> queries) {
  queries_ = static_cast<uint32_t>(queries.size());
  searches_ = 0;
  for (const gpu::Gathered& query : queries) searches_ += query.count;
  run_.begin();
  upload_.begin();
  upload_.add(queries.data(), queries.size_bytes(), gathered_);
}

void GatherPass::record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first) {
  gpu::computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kGather, queries_, gpu::GatherPush{queries_, searches_, first},
       {{gpu::kSlotResults, results}, {gpu::kSlotGathered, gathered_}, {gpu::kSlotOrder, order_}});
}

}  // namespace radar
