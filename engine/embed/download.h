// Reads ranges of a host's buffers.
#pragma once

#include <cstddef>
#include <vector>

#include "gpu/buffer.h"

namespace radar {

class Download {
 public:
  explicit Download(const Device::Impl& device);
  /// Returns the number of the range.
  size_t add(VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes);
  /// Copies all ranges in one submission, and waits.
  void run();
  /// Of a range, after run().
  const std::byte* bytes(size_t range) const { return readback_.mapped() + ranges_[range].region.dstOffset; }

 private:
  struct Range {
    VkBuffer buffer;
    VkBufferCopy region;
  };
  const Device::Impl* device_;
  gpu::Buffer readback_;
  std::vector<Range> ranges_;
  VkDeviceSize end_ = 0;
};

}  // namespace radar
