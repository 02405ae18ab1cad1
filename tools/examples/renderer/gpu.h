// A small host's own Vulkan: a device with one queue, buffers, images, pipelines and barriers.
#pragma once

#include <cstring>
#include <span>
#include <vector>

#define VULKAN_HPP_NO_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>

#include "radar/recorder.h"

namespace example {

inline constexpr vk::Format kColour = vk::Format::eR8G8B8A8Unorm, kDepth = vk::Format::eD32Sfloat;
inline constexpr vk::SampleCountFlagBits kSamples = vk::SampleCountFlagBits::e4;

struct Gpu {
  /// `extensions`: of the instance, as the window system needs them; none: no window.
  explicit Gpu(const std::vector<const char*>& extensions) {
    const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
    instance = loader.createInstance({.pApplicationInfo = &application,
                                      .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                      .ppEnabledExtensionNames = extensions.data()});
    host = radar::hostOf(*instance);
    physical = {instance, host.physicalDevice};
    if (!(physical.getQueueFamilyProperties()[host.queueFamily].queueFlags & vk::QueueFlagBits::eGraphics))
      throw radar::Error("the device draws no pictures");

    // The renderer's own features. The engine's are added to these structs, or put in front of them.
    vk::PhysicalDeviceVulkan13Features own{.synchronization2 = VK_TRUE, .dynamicRendering = VK_TRUE};
    radar::Requirements needed = radar::requirements(host);
    const float priority = 1;
    const vk::DeviceQueueCreateInfo queueInfo{
        .queueFamilyIndex = host.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
    const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
    device = physical.createDevice({.pNext = needed.chain(&own),
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queueInfo,
                                    .enabledExtensionCount = extensions.empty() ? 0u : 1u,
                                    .ppEnabledExtensionNames = &swapchain});
    queue = device.getQueue(host.queueFamily, 0);
    pool = device.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = host.queueFamily});
    host.device = *device;
    host.queue = *queue;
  }

  vk::raii::Context loader;
  vk::raii::Instance instance = nullptr;
  radar::HostDevice host;  ///< what the engine adopts
  vk::raii::PhysicalDevice physical = nullptr;
  vk::raii::Device device = nullptr;
  vk::raii::Queue queue = nullptr;
  vk::raii::CommandPool pool = nullptr;
};

inline vk::raii::DeviceMemory allocate(const Gpu& gpu, const vk::MemoryRequirements& needed,
                                       vk::MemoryPropertyFlags wanted) {
  const vk::PhysicalDeviceMemoryProperties has = gpu.physical.getMemoryProperties();
  for (uint32_t i = 0; i < has.memoryTypeCount; ++i) {
    if ((needed.memoryTypeBits >> i & 1) != 0 && (has.memoryTypes[i].propertyFlags & wanted) == wanted)
      return gpu.device.allocateMemory({.allocationSize = needed.size, .memoryTypeIndex = i});
  }
  throw radar::Error("the device has no memory of the kind needed");
}

/// For shaders, the engine and the CPU. A renderer would keep most in memory that only the device sees.
struct Buffer {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Buffer handle = nullptr;
  vk::DeviceSize size = 0;
  void* mapped = nullptr;
};

inline Buffer makeBuffer(const Gpu& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage) {
  Buffer buffer;
  buffer.size = size;
  buffer.handle = gpu.device.createBuffer({.size = size, .usage = usage});
  buffer.memory = allocate(gpu, buffer.handle.getMemoryRequirements(),
                           vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent);
  buffer.handle.bindMemory(*buffer.memory, 0);
  buffer.mapped = buffer.memory.mapMemory(0, VK_WHOLE_SIZE);
  return buffer;
}

template <typename T>
Buffer makeFilled(const Gpu& gpu, const std::vector<T>& values, vk::BufferUsageFlags usage) {
  Buffer buffer = makeBuffer(gpu, sizeof(T) * values.size(), usage);
  std::memcpy(buffer.mapped, values.data(), buffer.size);
  return buffer;
}

struct Image {
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Image handle = nullptr;
  vk::raii::ImageView view = nullptr;
};

inline Image makeImage(const Gpu& gpu, vk::Extent2D size, vk::Format format, vk::SampleCountFlagBits samples,
                       vk::ImageUsageFlags usage) {
  Image image;
  image.handle = gpu.device.createImage({.imageType = vk::ImageType::e2D,
                                         .format = format,
                                         .extent = {size.width, size.height, 1},
                                         .mipLevels = 1,
                                         .arrayLayers = 1,
                                         .samples = samples,
                                         .usage = usage});
  image.memory = allocate(gpu, image.handle.getMemoryRequirements(), {});
  image.handle.bindMemory(*image.memory, 0);
  const auto aspect = format == kDepth ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
  image.view = gpu.device.createImageView({.image = *image.handle,
                                           .viewType = vk::ImageViewType::e2D,
                                           .format = format,
                                           .subresourceRange = {aspect, 0, 1, 0, 1}});
  return image;
}

using Code = std::span<const uint32_t>;

inline vk::raii::ShaderModule makeModule(const Gpu& gpu, Code code) {
  return gpu.device.createShaderModule({.codeSize = code.size_bytes(), .pCode = code.data()});
}

inline vk::raii::Pipeline makeCompute(const Gpu& gpu, vk::PipelineLayout layout, Code code) {
  const vk::raii::ShaderModule module = makeModule(gpu, code);
  const vk::PipelineShaderStageCreateInfo stage{
      .stage = vk::ShaderStageFlagBits::eCompute, .module = *module, .pName = "main"};
  return gpu.device.createComputePipeline(nullptr, {.stage = stage, .layout = layout});
}

inline vk::raii::Pipeline makeGraphics(const Gpu& gpu, vk::PipelineLayout layout, Code vertex, Code fragment,
                                       vk::Extent2D size) {
  const vk::raii::ShaderModule modules[] = {makeModule(gpu, vertex), makeModule(gpu, fragment)};
  const vk::PipelineShaderStageCreateInfo stages[] = {
      {.stage = vk::ShaderStageFlagBits::eVertex, .module = *modules[0], .pName = "main"},
      {.stage = vk::ShaderStageFlagBits::eFragment, .module = *modules[1], .pName = "main"}};
  const vk::PipelineVertexInputStateCreateInfo fetched;
  const vk::PipelineInputAssemblyStateCreateInfo assembly{.topology = vk::PrimitiveTopology::eTriangleList};
  const vk::Viewport all{0, 0, static_cast<float>(size.width), static_cast<float>(size.height), 0, 1};
  const vk::Rect2D area{{}, size};
  const vk::PipelineViewportStateCreateInfo viewport{
      .viewportCount = 1, .pViewports = &all, .scissorCount = 1, .pScissors = &area};
  const vk::PipelineRasterizationStateCreateInfo raster{.lineWidth = 1};
  const vk::PipelineMultisampleStateCreateInfo samples{.rasterizationSamples = kSamples};
  const vk::PipelineDepthStencilStateCreateInfo depth{
      .depthTestEnable = VK_TRUE, .depthWriteEnable = VK_TRUE, .depthCompareOp = vk::CompareOp::eLess};
  const vk::PipelineColorBlendAttachmentState opaque{.colorWriteMask = vk::ColorComponentFlags(0xf)};
  const vk::PipelineColorBlendStateCreateInfo blend{.attachmentCount = 1, .pAttachments = &opaque};
  const vk::PipelineRenderingCreateInfo rendering{
      .colorAttachmentCount = 1, .pColorAttachmentFormats = &kColour, .depthAttachmentFormat = kDepth};
  return gpu.device.createGraphicsPipeline(nullptr, {.pNext = &rendering,
                                                     .stageCount = 2,
                                                     .pStages = stages,
                                                     .pVertexInputState = &fetched,
                                                     .pInputAssemblyState = &assembly,
                                                     .pViewportState = &viewport,
                                                     .pRasterizationState = &raster,
                                                     .pMultisampleState = &samples,
                                                     .pDepthStencilState = &depth,
                                                     .pColorBlendState = &blend,
                                                     .layout = layout});
}

// Who accesses memory, and how.
using Access = radar::Access;
inline constexpr Access kEngineReads = radar::Recorder::kReads, kEngineWrites = radar::Recorder::kWrites;
inline constexpr Access kCompute{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                 VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
inline constexpr Access kCopy{VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT,
                              VK_ACCESS_2_TRANSFER_READ_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT};
inline constexpr Access kVertex{VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
inline constexpr Access kCpu{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};
inline constexpr Access kColourDrawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                                     VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
inline constexpr Access kDepthDrawn{
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT,
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT};
constexpr Access operator|(Access a, Access b) {
  return {a.stages | b.stages, a.access | b.access};
}

/// What was recorded before and accesses memory as `first` happens before what is recorded later and does as `then`.
inline void barrier(const vk::raii::CommandBuffer& commands, Access first, Access then) {
  const vk::MemoryBarrier2 memory{.srcStageMask = vk::PipelineStageFlags2(first.stages),
                                  .srcAccessMask = vk::AccessFlags2(first.access),
                                  .dstStageMask = vk::PipelineStageFlags2(then.stages),
                                  .dstAccessMask = vk::AccessFlags2(then.access)};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
}

/// The same for an image, whose layout changes.
inline void barrier(const vk::raii::CommandBuffer& commands, vk::Image image, Access first, vk::ImageLayout from,
                    Access then, vk::ImageLayout to, vk::ImageAspectFlags aspect = vk::ImageAspectFlagBits::eColor) {
  const vk::ImageMemoryBarrier2 memory{.srcStageMask = vk::PipelineStageFlags2(first.stages),
                                       .srcAccessMask = vk::AccessFlags2(first.access),
                                       .dstStageMask = vk::PipelineStageFlags2(then.stages),
                                       .dstAccessMask = vk::AccessFlags2(then.access),
                                       .oldLayout = from,
                                       .newLayout = to,
                                       .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                       .image = image,
                                       .subresourceRange = {aspect, 0, 1, 0, 1}};
  commands.pipelineBarrier2({.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &memory});
}

}  // namespace example
