// The Vulkan functions that the engine calls, loaded through the system's loader or the host's; the engine links none.
// What fails becomes a radar::Error that names the call.
#pragma once

#include <cstdint>

#include <vulkan/vulkan_core.h>

#include "radar/error.h"

// clang-format's output for these lists is not stable.
// clang-format off
#define RADAR_GLOBAL_FUNCTIONS(X) \
  X(CreateInstance) X(EnumerateInstanceExtensionProperties)

#define RADAR_INSTANCE_FUNCTIONS(X) \
  X(CreateDevice) X(DestroyInstance) X(EnumerateDeviceExtensionProperties) X(EnumeratePhysicalDevices) X(GetDeviceProcAddr) \
  X(GetPhysicalDeviceFeatures2) X(GetPhysicalDeviceMemoryProperties) X(GetPhysicalDeviceProperties) \
  X(GetPhysicalDeviceProperties2) X(GetPhysicalDeviceQueueFamilyProperties)

#define RADAR_DEVICE_FUNCTIONS(X) \
  X(AllocateCommandBuffers) X(AllocateDescriptorSets) X(AllocateMemory) X(BeginCommandBuffer) X(BindBufferMemory) \
  X(BindImageMemory) X(CmdBeginRenderPass) X(CmdBindDescriptorSets) X(CmdBindIndexBuffer) X(CmdBindPipeline) \
  X(CmdBindVertexBuffers) X(CmdCopyBuffer) X(CmdCopyImageToBuffer) X(CmdDispatch) X(CmdDispatchIndirect) \
  X(CmdDrawIndexed) X(CmdEndRenderPass) X(CmdFillBuffer) X(CmdPipelineBarrier2) X(CmdPushConstants) X(CmdResetQueryPool) \
  X(CmdSetScissor) X(CmdSetViewport) X(CmdWriteTimestamp2) X(CreateBuffer) X(CreateBufferView) X(CreateCommandPool) \
  X(CreateComputePipelines) X(CreateDescriptorPool) X(CreateDescriptorSetLayout) X(CreateFence) \
  X(CreateFramebuffer) X(CreateGraphicsPipelines) X(CreateImage) X(CreateImageView) X(CreatePipelineLayout) \
  X(CreateQueryPool) X(CreateRenderPass) X(CreateSampler) X(CreateShaderModule) X(DestroyBuffer) X(DestroyBufferView) \
  X(DestroyCommandPool) X(DestroyDescriptorPool) X(DestroyDescriptorSetLayout) X(DestroyDevice) X(DestroyFence) \
  X(DestroyFramebuffer) X(DestroyImage) X(DestroyImageView) X(DestroyPipeline) X(DestroyPipelineLayout) \
  X(DestroyQueryPool) X(DestroyRenderPass) X(DestroySampler) X(DestroyShaderModule) X(EndCommandBuffer) \
  X(FreeMemory) X(GetBufferMemoryRequirements) X(GetDeviceQueue) X(GetImageMemoryRequirements) \
  X(GetQueryPoolResults) X(MapMemory) X(QueueSubmit2) X(ResetCommandBuffer) X(ResetFences) X(UpdateDescriptorSets) \
  X(WaitForFences)

// Functions of VK_EXT_debug_utils: null if the instance lacks it.
#define RADAR_DEBUG_FUNCTIONS(X) \
  X(CmdBeginDebugUtilsLabelEXT) X(CmdEndDebugUtilsLabelEXT) X(CreateDebugUtilsMessengerEXT) \
  X(DestroyDebugUtilsMessengerEXT) X(SetDebugUtilsObjectNameEXT)

// Functions of VK_KHR_pipeline_executable_properties: null if the device lacks it.
#define RADAR_STATISTICS_FUNCTIONS(X) \
  X(GetPipelineExecutableStatisticsKHR)
// clang-format on

namespace radar::gpu {

/// vkGetInstanceProcAddr of the system's Vulkan loader, opened at first use and kept. Throws if there is none.
PFN_vkGetInstanceProcAddr systemLoader();

/// The functions, without the prefix "vk". The constructor and load() fill them in step by step; each throws, naming
/// the function, if one is missing.
struct Api {
  /// Loads the functions that need no instance. Null: uses the system's loader.
  explicit Api(PFN_vkGetInstanceProcAddr get);
  void load(VkInstance instance);
  void load(VkDevice device);

  PFN_vkGetInstanceProcAddr GetInstanceProcAddr = nullptr;
#define RADAR_DECLARE(name) PFN_vk##name name = nullptr;
  RADAR_GLOBAL_FUNCTIONS(RADAR_DECLARE)
  RADAR_INSTANCE_FUNCTIONS(RADAR_DECLARE)
  RADAR_DEVICE_FUNCTIONS(RADAR_DECLARE)
  RADAR_DEBUG_FUNCTIONS(RADAR_DECLARE)
  RADAR_STATISTICS_FUNCTIONS(RADAR_DECLARE)
#undef RADAR_DECLARE
};

/// A command buffer being recorded, with the functions that record into it.
struct Commands {
  const Api* api = nullptr;
  VkCommandBuffer handle = VK_NULL_HANDLE;
  const Api* operator->() const { return api; }
  operator VkCommandBuffer() const { return handle; }
};

/// A scene or a batch is larger than the device's limits allow; no Vulkan call failed, and nothing was submitted.
struct LimitError : Error {
  explicit LimitError(const std::string& what) : Error(Kind::device, what) {}
};

const char* resultName(VkResult result);

/// Throws if `result` is an error, naming the call, and what it was for: "vkCreateBuffer (nodes, 64 bytes)". Makes text
/// for an error only: memory may run out between a call and what is to own the object that it made.
void check(VkResult result, const char* call, const char* about = nullptr, uint64_t size = 0,
           const char* unit = "bytes");

/// Whether a call failed for lack of memory, of the device or of the host.
bool isOutOfMemory(const Error& error);
bool isLost(const Error& error);  ///< the device

}  // namespace radar::gpu
