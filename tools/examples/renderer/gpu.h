// A small host's own Vulkan: a device with one queue, buffers, images, pipelines, and the one place where barriers are
// made.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <vulkan/vulkan.h>

#include "radar/device.h"

namespace example {

/// Throws radar::Error, naming the call, unless it succeeded.
void require(VkResult result, const char* call);

/// Destroys what it was told to, last first.
class Lifetime {
 public:
  Lifetime() = default;
  Lifetime(const Lifetime&) = delete;
  Lifetime& operator=(const Lifetime&) = delete;
  ~Lifetime() { end(); }
  void add(std::function<void()> end) { ends_.push_back(std::move(end)); }
  template <typename Handle>
  void add(VkDevice device, Handle handle, void(VKAPI_PTR* destroy)(VkDevice, Handle, const VkAllocationCallbacks*)) {
    add([=] { destroy(device, handle, nullptr); });
  }
  void end() {
    for (; !ends_.empty(); ends_.pop_back()) ends_.back()();
  }

 private:
  std::vector<std::function<void()>> ends_;
};

class Gpu {
 public:
  /// `extensions`: of the instance, as the window system needs them; none: no window.
  explicit Gpu(std::span<const char* const> extensions);
  /// What the engine adopts.
  radar::HostDevice handles() const;
  uint32_t memoryType(uint32_t allowed, VkMemoryPropertyFlags wanted) const;

  VkInstance instance;
  VkPhysicalDevice physical;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t family;
  std::string name;
  double nanosecondsPerTick;

 private:
  void choose();

  Lifetime lifetime_;
  bool doubles_ = false;
};

struct Buffer {
  VkBuffer handle = VK_NULL_HANDLE;
  VkDeviceSize size = 0;
  std::byte* mapped = nullptr;  ///< null on the device
};
enum class Where { device, host };
Buffer makeBuffer(const Gpu& gpu, Lifetime& lifetime, VkDeviceSize size, VkBufferUsageFlags usage, Where where);
/// A command buffer that may be recorded again and again.
VkCommandBuffer makeCommands(const Gpu& gpu, Lifetime& lifetime);
/// A buffer on the device with these bytes; waits.
Buffer makeFilled(const Gpu& gpu, Lifetime& lifetime, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

struct Image {
  VkImage handle = VK_NULL_HANDLE;
  VkImageView view = VK_NULL_HANDLE;
};
Image makeImage(const Gpu& gpu, Lifetime& lifetime, VkExtent2D size, VkFormat format, VkSampleCountFlagBits samples,
                VkImageUsageFlags usage);

inline constexpr VkFormat kColour = VK_FORMAT_R8G8B8A8_UNORM, kDepth = VK_FORMAT_D32_SFLOAT;
inline constexpr VkSampleCountFlagBits kSamples = VK_SAMPLE_COUNT_4_BIT;

using Code = std::span<const uint32_t>;
VkPipeline makeCompute(const Gpu& gpu, Lifetime& lifetime, VkPipelineLayout layout, Code code);
VkPipeline makeGraphics(const Gpu& gpu, Lifetime& lifetime, VkPipelineLayout layout, Code vertex, Code fragment,
                        VkPrimitiveTopology topology);

/// A stage, and how it accesses memory.
struct Access {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
};
inline constexpr Access kFilled{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kComputed{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
inline constexpr Access kCompute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
inline constexpr Access kCopyRead{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Access kCopied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kBlitRead{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_READ_BIT};
inline constexpr Access kBlitted{VK_PIPELINE_STAGE_2_BLIT_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kVertexRead{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
inline constexpr Access kHostRead{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
inline constexpr Access kColourDrawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
inline constexpr Access kDepthDrawn{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};

/// All that was recorded before and accesses memory as `first` happens before what accesses it as `then`.
void barrier(VkCommandBuffer commands, Access first, Access then);
/// The same for an image, which gets another layout.
void barrier(VkCommandBuffer commands, VkImage image, Access first, VkImageLayout from, Access then, VkImageLayout to,
             VkImageAspectFlags aspect = VK_IMAGE_ASPECT_COLOR_BIT);

}  // namespace example
