#include "gpu.h"

#include <cstring>

#include "radar/error.h"

namespace example {

namespace {

VkShaderModule makeModule(const Gpu& gpu, Lifetime& lifetime, Code code) {
  const VkShaderModuleCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = code.size_bytes(), .pCode = code.data()};
  VkShaderModule module;
  require(vkCreateShaderModule(gpu.device, &info, nullptr, &module), "vkCreateShaderModule");
  lifetime.add(gpu.device, module, vkDestroyShaderModule);
  return module;
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, VkShaderModule module) {
  return {
      .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO, .stage = stage, .module = module, .pName = "main"};
}

VkDeviceMemory allocate(const Gpu& gpu, Lifetime& lifetime, const VkMemoryRequirements& needed,
                        VkMemoryPropertyFlags wanted) {
  const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                  .allocationSize = needed.size,
                                  .memoryTypeIndex = gpu.memoryType(needed.memoryTypeBits, wanted)};
  VkDeviceMemory memory;
  require(vkAllocateMemory(gpu.device, &info, nullptr, &memory), "vkAllocateMemory");
  lifetime.add(gpu.device, memory, vkFreeMemory);
  return memory;
}

}  // namespace

void require(VkResult result, const char* call) {
  if (result < 0) throw radar::Error(std::string(call) + " failed", result);
}

Gpu::Gpu(std::span<const char* const> extensions) {
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo instanceInfo{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                          .pApplicationInfo = &application,
                                          .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                          .ppEnabledExtensionNames = extensions.data()};
  require(vkCreateInstance(&instanceInfo, nullptr, &instance), "vkCreateInstance");
  lifetime_.add([this] { vkDestroyInstance(instance, nullptr); });
  choose();

  // The renderer's own features. The engine's are added to these structs, or put in front of them.
  VkPhysicalDeviceVulkan13Features own{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                       .synchronization2 = VK_TRUE,
                                       .dynamicRendering = VK_TRUE};
  radar::Requirements needed = radar::requirements(handles());
  const float priority = 1;
  const VkDeviceQueueCreateInfo queueInfo{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                          .queueFamilyIndex = family,
                                          .queueCount = 1,
                                          .pQueuePriorities = &priority};
  const char* swapchain = VK_KHR_SWAPCHAIN_EXTENSION_NAME;
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = needed.chain(&own),
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queueInfo,
                                .enabledExtensionCount = extensions.empty() ? 0u : 1u,
                                .ppEnabledExtensionNames = &swapchain};
  require(vkCreateDevice(physical, &info, nullptr, &device), "vkCreateDevice");
  lifetime_.add([this] { vkDestroyDevice(device, nullptr); });
  vkGetDeviceQueue(device, family, 0, &queue);
}

/// Takes the first device that both the engine and the renderer can use.
void Gpu::choose() {
  uint32_t count = 0;
  require(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> all(count);
  require(vkEnumeratePhysicalDevices(instance, &count, all.data()), "vkEnumeratePhysicalDevices");
  std::vector<std::string> why;
  for (const VkPhysicalDevice candidate : all) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(candidate, &properties);
    const std::string who = std::string(properties.deviceName) + " ";
    const radar::HostDevice asked{.instance = instance, .physicalDevice = candidate};
    const std::vector<std::string> reasons = radar::unsupportedReasons(asked, radar::Mode::contact);
    for (const std::string& reason : reasons) why.push_back(who + reason);
    if (!reasons.empty()) continue;

    uint32_t families = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, nullptr);
    std::vector<VkQueueFamilyProperties> queues(families);
    vkGetPhysicalDeviceQueueFamilyProperties(candidate, &families, queues.data());
    for (family = 0; family < families; ++family) {
      const VkQueueFlags both = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
      if ((queues[family].queueFlags & both) == both && queues[family].timestampValidBits != 0) break;
    }
    if (family == families) {
      why.push_back(who + "has no queue family with graphics, compute and timestamps");
      continue;
    }
    VkPhysicalDeviceFeatures has;
    vkGetPhysicalDeviceFeatures(candidate, &has);
    physical = candidate;
    name = properties.deviceName;
    nanosecondsPerTick = properties.limits.timestampPeriod;
    doubles_ = has.shaderFloat64 == VK_TRUE;
    return;
  }
  throw radar::Error("there is no usable Vulkan device", 0, why);
}

radar::HostDevice Gpu::handles() const {
  return {.instance = instance,
          .physicalDevice = physical,
          .device = device,
          .queueFamily = family,
          .queue = queue,
          .doubles = doubles_,
          .getInstanceProcAddr = vkGetInstanceProcAddr};
}

uint32_t Gpu::memoryType(uint32_t allowed, VkMemoryPropertyFlags wanted) const {
  VkPhysicalDeviceMemoryProperties has;
  vkGetPhysicalDeviceMemoryProperties(physical, &has);
  for (uint32_t i = 0; i < has.memoryTypeCount; ++i)
    if ((allowed >> i & 1) != 0 && (has.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw radar::Error("the device has no memory of the kind needed");
}

Buffer makeBuffer(const Gpu& gpu, Lifetime& lifetime, VkDeviceSize size, VkBufferUsageFlags usage, Where where) {
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage};
  Buffer buffer{.size = size};
  require(vkCreateBuffer(gpu.device, &info, nullptr, &buffer.handle), "vkCreateBuffer");
  lifetime.add(gpu.device, buffer.handle, vkDestroyBuffer);
  VkMemoryRequirements needed;
  vkGetBufferMemoryRequirements(gpu.device, buffer.handle, &needed);
  const bool onHost = where == Where::host;
  const VkDeviceMemory memory = allocate(
      gpu, lifetime, needed,
      onHost ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT : VkMemoryPropertyFlags{0});
  require(vkBindBufferMemory(gpu.device, buffer.handle, memory, 0), "vkBindBufferMemory");
  void* mapped = nullptr;
  if (onHost) require(vkMapMemory(gpu.device, memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory");
  buffer.mapped = static_cast<std::byte*>(mapped);
  return buffer;
}

Buffer makeFilled(const Gpu& gpu, Lifetime& lifetime, std::span<const std::byte> bytes, VkBufferUsageFlags usage) {
  const Buffer buffer =
      makeBuffer(gpu, lifetime, bytes.size(), usage | VK_BUFFER_USAGE_TRANSFER_DST_BIT, Where::device);
  Lifetime local;
  const Buffer staging = makeBuffer(gpu, local, bytes.size(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT, Where::host);
  std::memcpy(staging.mapped, bytes.data(), bytes.size());
  const VkCommandBuffer commands = makeCommands(gpu, local);
  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  require(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
  const VkBufferCopy all{.size = bytes.size()};
  vkCmdCopyBuffer(commands, staging.handle, buffer.handle, 1, &all);
  require(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
  const VkSubmitInfo submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO, .commandBufferCount = 1, .pCommandBuffers = &commands};
  require(vkQueueSubmit(gpu.queue, 1, &submit, VK_NULL_HANDLE), "vkQueueSubmit");
  require(vkQueueWaitIdle(gpu.queue), "vkQueueWaitIdle");
  return buffer;
}

VkCommandBuffer makeCommands(const Gpu& gpu, Lifetime& lifetime) {
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                         .queueFamilyIndex = gpu.family};
  VkCommandPool pool;
  require(vkCreateCommandPool(gpu.device, &poolInfo, nullptr, &pool), "vkCreateCommandPool");
  lifetime.add(gpu.device, pool, vkDestroyCommandPool);
  const VkCommandBufferAllocateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, .commandPool = pool, .commandBufferCount = 1};
  VkCommandBuffer commands;
  require(vkAllocateCommandBuffers(gpu.device, &info, &commands), "vkAllocateCommandBuffers");
  return commands;
}

Image makeImage(const Gpu& gpu, Lifetime& lifetime, VkExtent2D size, VkFormat format, VkSampleCountFlagBits samples,
                VkImageUsageFlags usage) {
  const VkImageCreateInfo info{.sType = VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO,
                               .imageType = VK_IMAGE_TYPE_2D,
                               .format = format,
                               .extent = {size.width, size.height, 1},
                               .mipLevels = 1,
                               .arrayLayers = 1,
                               .samples = samples,
                               .tiling = VK_IMAGE_TILING_OPTIMAL,
                               .usage = usage};
  Image image;
  require(vkCreateImage(gpu.device, &info, nullptr, &image.handle), "vkCreateImage");
  lifetime.add(gpu.device, image.handle, vkDestroyImage);
  VkMemoryRequirements needed;
  vkGetImageMemoryRequirements(gpu.device, image.handle, &needed);
  require(vkBindImageMemory(gpu.device, image.handle, allocate(gpu, lifetime, needed, 0), 0), "vkBindImageMemory");
  const VkImageAspectFlags aspect = format == kDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  const VkImageViewCreateInfo viewInfo{.sType = VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO,
                                       .image = image.handle,
                                       .viewType = VK_IMAGE_VIEW_TYPE_2D,
                                       .format = format,
                                       .subresourceRange = {aspect, 0, 1, 0, 1}};
  require(vkCreateImageView(gpu.device, &viewInfo, nullptr, &image.view), "vkCreateImageView");
  lifetime.add(gpu.device, image.view, vkDestroyImageView);
  return image;
}

VkPipeline makeCompute(const Gpu& gpu, Lifetime& lifetime, VkPipelineLayout layout, Code code) {
  Lifetime local;
  const VkComputePipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO,
                                         .stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, makeModule(gpu, local, code)),
                                         .layout = layout};
  VkPipeline pipeline;
  require(vkCreateComputePipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateComputePipelines");
  lifetime.add(gpu.device, pipeline, vkDestroyPipeline);
  return pipeline;
}

VkPipeline makeGraphics(const Gpu& gpu, Lifetime& lifetime, VkPipelineLayout layout, Code vertex, Code fragment,
                        VkPrimitiveTopology topology) {
  Lifetime local;
  const VkPipelineShaderStageCreateInfo stages[] = {
      stageOf(VK_SHADER_STAGE_VERTEX_BIT, makeModule(gpu, local, vertex)),
      stageOf(VK_SHADER_STAGE_FRAGMENT_BIT, makeModule(gpu, local, fragment))};
  const VkPipelineVertexInputStateCreateInfo fetched{.sType =
                                                         VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO, .topology = topology};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO, .lineWidth = 1};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = kSamples};
  const VkPipelineDepthStencilStateCreateInfo depth{.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                    .depthTestEnable = VK_TRUE,
                                                    .depthWriteEnable = VK_TRUE,
                                                    .depthCompareOp = VK_COMPARE_OP_LESS};
  const VkPipelineColorBlendAttachmentState opaque{.colorWriteMask = 0xf};
  const VkPipelineColorBlendStateCreateInfo blend{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO, .attachmentCount = 1, .pAttachments = &opaque};
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, .dynamicStateCount = 2, .pDynamicStates = states};
  const VkPipelineRenderingCreateInfo rendering{.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO,
                                                .colorAttachmentCount = 1,
                                                .pColorAttachmentFormats = &kColour,
                                                .depthAttachmentFormat = kDepth};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .pNext = &rendering,
                                          .stageCount = 2,
                                          .pStages = stages,
                                          .pVertexInputState = &fetched,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pColorBlendState = &blend,
                                          .pDynamicState = &dynamic,
                                          .layout = layout};
  VkPipeline pipeline;
  require(vkCreateGraphicsPipelines(gpu.device, VK_NULL_HANDLE, 1, &info, nullptr, &pipeline),
          "vkCreateGraphicsPipelines");
  lifetime.add(gpu.device, pipeline, vkDestroyPipeline);
  return pipeline;
}

void barrier(VkCommandBuffer commands, Access first, Access then) {
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = first.stage,
                                .srcAccessMask = first.access,
                                .dstStageMask = then.stage,
                                .dstAccessMask = then.access};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &memory};
  vkCmdPipelineBarrier2(commands, &info);
}

void barrier(VkCommandBuffer commands, VkImage image, Access first, VkImageLayout from, Access then, VkImageLayout to,
             VkImageAspectFlags aspect) {
  const VkImageMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2,
                                     .srcStageMask = first.stage,
                                     .srcAccessMask = first.access,
                                     .dstStageMask = then.stage,
                                     .dstAccessMask = then.access,
                                     .oldLayout = from,
                                     .newLayout = to,
                                     .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
                                     .image = image,
                                     .subresourceRange = {aspect, 0, 1, 0, 1}};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &memory};
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace example
