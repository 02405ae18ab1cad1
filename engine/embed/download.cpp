#include "embed/download.h"

#include "gpu/barrier.h"
#include "gpu/submission.h"

namespace radar {

Download::Download(const Device::Impl& device)
    : device_(&device),
      readback_(device, "host geometry", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

size_t Download::add(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
  ranges_.push_back({buffer, {first, end_, bytes}});
  end_ += gpu::roundedUp(bytes, 8);
  return ranges_.size() - 1;
}

void Download::run() {
  if (ranges_.empty()) return;
  readback_.reserve(end_);
  gpu::Submission submission(*device_, false);
  const gpu::Commands commands = submission.begin();
  submission.stage("host geometry");
  for (const Range& range : ranges_) commands->CmdCopyBuffer(commands, range.buffer, readback_.get(), 1, &range.region);
  gpu::copyToHost(commands);
  submission.submitAndWait();
}

}  // namespace radar
