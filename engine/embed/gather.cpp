#include "embed/gather.h"

#include "gpu/barrier.h"
#include "gpu/device.h"
#include "shaders/contact/interop.h"
#include "spirv/embed_gather_comp.h"

namespace radar {

namespace {

// Created once per device.
struct GatherKernel {
  explicit GatherKernel(const Device::Impl& device) : gather(device, k_embed_gather_comp, "gather") {}
  gpu::Kernel gather;
};

}  // namespace

GatherPass::GatherPass(const Device::Impl& device, uint32_t searches)
    : upload_(device),
      buffer_(device, "searches to gather", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      gather_(device.shared<GatherKernel>().gather) {
  buffer_.reserve(searches);
}

void GatherPass::stage() {
  upload_.begin(gpu::Upload::aligned(gpu::bytesOf(searches_)));
  upload_.add(searches_.data(), gpu::bytesOf(searches_), buffer_);
}

void GatherPass::record(const gpu::Commands& commands, const gpu::Array<Result>& results, uint32_t first) {
  gpu::computeWriteToComputeReadWrite(commands);
  gather_.set({{gpu::kSlotResults, results}, {gpu::kSlotGathered, buffer_}});
  gather_.dispatch(commands, gpu::groupsFor(searchCount(), gpu::kHostGroup), gpu::GatherPush{searchCount(), first});
}

}  // namespace radar
