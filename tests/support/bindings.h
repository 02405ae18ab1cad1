// A descriptor set made without gpu::Kernel, as a host makes it, so that tests can also bind a host's buffers.
#pragma once

#include "gpu/device.h"

namespace radar::test {

/// One set of storage buffers, numbered from 0, for compute shaders, and its pipeline layout.
class Bindings {
 public:
  Bindings(const Device::Impl& device, uint32_t buffers, uint32_t pushBytes);

  void setBuffer(uint32_t number, VkBuffer buffer);
  void bind(const gpu::Commands& commands) const;
  VkPipelineLayout layout() const { return pipelineLayout_.get(); }

 private:
  const Device::Impl* device_;
  gpu::DescriptorSetLayout setLayout_;
  gpu::PipelineLayout pipelineLayout_;
  gpu::DescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

}  // namespace radar::test
