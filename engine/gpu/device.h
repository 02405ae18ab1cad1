// A logical device with one queue, opened or adopted. Opening creates the handles, then adopts them.
#pragma once

#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <typeindex>
#include <utility>

#include "gpu/api.h"
#include "radar/device.h"

namespace radar {

namespace gpu {
class Allocator;
}

struct Device::Impl {
  Impl(const HostDevice& host);
  ~Impl();

  /// Only if opened here. Declared first, so destroyed last.
  struct Owned {
    gpu::Api vk{nullptr};
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    std::function<void(const std::string&)> onValidation;
    ~Owned();
  };
  std::unique_ptr<Owned> owned;

  HostDevice host;
  gpu::Api vk;
  mutable std::mutex queueMutex;  ///< held around each submission
  /// The device has been given up while it was at work, so that nothing of it may be destroyed.
  mutable std::atomic<bool> abandoned = false;
  VkPhysicalDeviceProperties properties{};
  VkPhysicalDeviceMemoryProperties memory{};
  std::unique_ptr<gpu::Allocator> allocator;  ///< gpu/memory.h
  std::string name, driver;
  std::vector<std::string> reasonsAgainstSampled;  ///< why mode sampled is not supported; empty if it is
  uint32_t maxLayers = 0;
  bool choosesLayers = false;  ///< a vertex shader may choose the layer; else a render pass draws one
  uint64_t maxBufferBytes = 0;
  uint32_t subgroupSize = 0;         ///< of full subgroups (gpu/kernel.h)
  bool choosesSubgroupSize = false;  ///< a compute pipeline may request a size; else all have the same
  bool doubles = false;              ///< shaders may compute with them
  bool dividesRight =
      false;  ///< quotients of doubles have the CPU's bits; else shaders/shared/divide.glsl corrects them
  bool capturesStatistics = false;  ///< VK_KHR_pipeline_executable_properties tells of pipelines

  VkDevice device() const { return host.device; }
  bool runsOnCpu() const { return properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU; }
  /// Throws with the reasons, naming `who`, if the device does not support mode sampled.
  void requireSampled(const std::string& who) const;
  /// Throws, naming `who`, if the host gave no queue.
  void requireQueue(const char* who) const;
  /// Names an object for debuggers and validation messages.
  void setName(VkObjectType type, uint64_t handle, const char* name) const;
  template <class T>
  void setName(VkObjectType type, T handle, const char* text) const {
    setName(type, reinterpret_cast<uint64_t>(handle), text);
  }
  /// Opens and closes a labelled region of a command buffer.
  void beginLabel(const gpu::Commands& commands, const char* label) const;
  void endLabel(const gpu::Commands& commands) const;

  /// The device's single T, constructed as T(const Device::Impl&) on first use and destroyed with the device. Any
  /// thread may call it. T's constructor may call it for other types.
  template <class T>
  const T& shared() const;

 private:
  struct Shared {
    std::mutex mutex;
    std::shared_ptr<const void> object;
  };
  Shared& sharedOf(std::type_index type) const;
  mutable std::mutex sharedMutex_;
  // Declared last, so that its objects are destroyed before the device that made them.
  mutable std::map<std::type_index, Shared> shared_;
};

template <class T>
const T& Device::Impl::shared() const {
  Shared& mine = sharedOf(typeid(T));
  const std::lock_guard lock(mine.mutex);
  if (mine.object == nullptr) mine.object = std::make_shared<const T>(*this);
  return *static_cast<const T*>(mine.object.get());
}

namespace gpu {

/// Owns a child object of a VkDevice, which must outlive it.
template <class Kind>
class Handle {
 public:
  using Value = typename Kind::Value;
  Handle() = default;
  Handle(const Device::Impl& device, Value value) : device_(&device), value_(value) {}
  /// Makes one, and names it, if `name` is given. Throws Error, which says what it is for and `size`: see check().
  template <class Info>
  Handle(const Device::Impl& device, const Info& info, const char* name = nullptr, uint64_t size = 0,
         const char* unit = "bytes")
      : Handle(device, made(device, info, name, size, unit)) {
    if (name != nullptr) device.setName(Kind::kType, value_, name);
  }
  Handle(Handle&& other) noexcept
      : device_(other.device_), value_(std::exchange(other.value_, static_cast<Value>(VK_NULL_HANDLE))) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(value_, other.value_);
    return *this;
  }
  ~Handle() {
    if (value_ != VK_NULL_HANDLE && !device_->abandoned)
      (device_->vk.*Kind::kDestroy)(device_->device(), value_, device_->host.allocator);
  }
  Value get() const { return value_; }

 private:
  template <class Info>
  static Value made(const Device::Impl& device, const Info& info, const char* name, uint64_t size, const char* unit) {
    Value value;
    check((device.vk.*Kind::kCreate)(device.device(), &info, device.host.allocator, &value), Kind::kCall, name, size,
          unit);
    return value;
  }

  const Device::Impl* device_ = nullptr;
  Value value_ = VK_NULL_HANDLE;
};

#define RADAR_HANDLE(name, object, create, destroy, type) \
  struct name##Kind {                                     \
    using Value = Vk##object;                             \
    static constexpr auto kCreate = &Api::create;         \
    static constexpr auto kDestroy = &Api::destroy;       \
    static constexpr const char* kCall = "vk" #create;    \
    static constexpr auto kType = VK_OBJECT_TYPE_##type;  \
  };                                                      \
  using name = Handle<name##Kind>;
RADAR_HANDLE(CommandPool, CommandPool, CreateCommandPool, DestroyCommandPool, COMMAND_POOL)
RADAR_HANDLE(DescriptorPool, DescriptorPool, CreateDescriptorPool, DestroyDescriptorPool, DESCRIPTOR_POOL)
RADAR_HANDLE(DescriptorSetLayout, DescriptorSetLayout, CreateDescriptorSetLayout, DestroyDescriptorSetLayout,
             DESCRIPTOR_SET_LAYOUT)
RADAR_HANDLE(DeviceMemory, DeviceMemory, AllocateMemory, FreeMemory, DEVICE_MEMORY)
RADAR_HANDLE(Fence, Fence, CreateFence, DestroyFence, FENCE)
RADAR_HANDLE(Framebuffer, Framebuffer, CreateFramebuffer, DestroyFramebuffer, FRAMEBUFFER)
RADAR_HANDLE(ImageHandle, Image, CreateImage, DestroyImage, IMAGE)
RADAR_HANDLE(ImageView, ImageView, CreateImageView, DestroyImageView, IMAGE_VIEW)
RADAR_HANDLE(BufferHandle, Buffer, CreateBuffer, DestroyBuffer, BUFFER)
RADAR_HANDLE(BufferView, BufferView, CreateBufferView, DestroyBufferView, BUFFER_VIEW)
RADAR_HANDLE(Pipeline, Pipeline, CreateComputePipelines, DestroyPipeline, PIPELINE)
RADAR_HANDLE(PipelineLayout, PipelineLayout, CreatePipelineLayout, DestroyPipelineLayout, PIPELINE_LAYOUT)
RADAR_HANDLE(QueryPool, QueryPool, CreateQueryPool, DestroyQueryPool, QUERY_POOL)
RADAR_HANDLE(RenderPass, RenderPass, CreateRenderPass, DestroyRenderPass, RENDER_PASS)
RADAR_HANDLE(Sampler, Sampler, CreateSampler, DestroySampler, SAMPLER)
RADAR_HANDLE(ShaderModule, ShaderModule, CreateShaderModule, DestroyShaderModule, SHADER_MODULE)
#undef RADAR_HANDLE

/// A device that makes pipelines and tells of them, if its driver can. Its arithmetic is not checked.
std::unique_ptr<Device::Impl> openForStatistics(uint32_t index);

/// Name and version, as the driver gives them.
std::string driverText(const Api& vk, VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties);

}  // namespace gpu
}  // namespace radar
