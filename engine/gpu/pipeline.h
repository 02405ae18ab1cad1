// Descriptor sets and pipelines. All shaders of the engine use the binding numbers of shaders/interop.h.
#pragma once

#include <initializer_list>
#include <span>

#include "gpu/buffer.h"
#include "gpu/device.h"
#include "gpu/handle.h"

namespace radar::gpu {

struct Binding {
  uint32_t number;
  VkDescriptorType type;
};

/// The set layout, the pipeline layout (push constants: `pushBytes`, compute) and one descriptor set.
class Bindings {
 public:
  Bindings(const Device::Impl& device, std::span<const Binding> bindings, uint32_t pushBytes);

  /// Binds at most the device's maxStorageBufferRange; ignores an empty buffer.
  void setBuffer(uint32_t number, const Buffer& buffer);
  void setImage(uint32_t number, VkImageView view, VkSampler sampler);
  /// Binds the set for compute shaders.
  void bind(const Commands& commands) const;
  VkPipelineLayout layout() const { return pipelineLayout_.get(); }
  VkDescriptorSet set() const { return set_; }

 private:
  const Device::Impl* device_;
  DescriptorSetLayout setLayout_;
  PipelineLayout pipelineLayout_;
  DescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
};

/// `constants`: values of specialization constants 0, 1, ..., if the shader has any. `fullSubgroups`: all subgroups
/// have Device::Impl::subgroupSize invocations; the local size is a multiple of it.
Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants = {}, bool fullSubgroups = false);

/// Depth only, no fragment shader, nothing culled; positions are float x3 at vertex binding 0, `stride` bytes apart;
/// viewport and scissor are dynamic; the depth test is less.
Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, VkRenderPass renderPass,
                       std::span<const uint32_t> spirv, const char* name, uint32_t stride);

}  // namespace radar::gpu
