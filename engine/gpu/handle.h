// A move-only owning handle for child objects of a VkDevice, which must outlive it.
#pragma once

#include <utility>

#include "gpu/device.h"

namespace radar::gpu {

template <class T, auto Destroy>
class Handle {
 public:
  Handle() = default;
  Handle(const Device::Impl& device, T value) : device_(&device), value_(value) {}
  Handle(Handle&& other) noexcept
      : device_(other.device_), value_(std::exchange(other.value_, static_cast<T>(VK_NULL_HANDLE))) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(value_, other.value_);
    return *this;
  }
  ~Handle() {
    if (value_ != VK_NULL_HANDLE && !device_->abandoned)
      (device_->vk.*Destroy)(device_->device(), value_, device_->host.allocator);
  }
  T get() const { return value_; }

 private:
  const Device::Impl* device_ = nullptr;
  T value_ = VK_NULL_HANDLE;
};

using CommandPool = Handle<VkCommandPool, &Api::DestroyCommandPool>;
using DescriptorPool = Handle<VkDescriptorPool, &Api::DestroyDescriptorPool>;
using DescriptorSetLayout = Handle<VkDescriptorSetLayout, &Api::DestroyDescriptorSetLayout>;
using DeviceMemory = Handle<VkDeviceMemory, &Api::FreeMemory>;
using Fence = Handle<VkFence, &Api::DestroyFence>;
using Framebuffer = Handle<VkFramebuffer, &Api::DestroyFramebuffer>;
using ImageHandle = Handle<VkImage, &Api::DestroyImage>;
using ImageView = Handle<VkImageView, &Api::DestroyImageView>;
using BufferHandle = Handle<VkBuffer, &Api::DestroyBuffer>;
using BufferView = Handle<VkBufferView, &Api::DestroyBufferView>;
using Pipeline = Handle<VkPipeline, &Api::DestroyPipeline>;
using PipelineLayout = Handle<VkPipelineLayout, &Api::DestroyPipelineLayout>;
using QueryPool = Handle<VkQueryPool, &Api::DestroyQueryPool>;
using RenderPass = Handle<VkRenderPass, &Api::DestroyRenderPass>;
using Sampler = Handle<VkSampler, &Api::DestroySampler>;
using ShaderModule = Handle<VkShaderModule, &Api::DestroyShaderModule>;

}  // namespace radar::gpu
