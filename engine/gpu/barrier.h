// Every barrier of the engine, named by its purpose. synchronization2, exact stages and accesses.
#pragma once

#include <vulkan/vulkan_core.h>

namespace radar::gpu {

/// A batch's upload is read by depth passes (vertices, indices, draws) and by compute shaders.
void uploadToRead(VkCommandBuffer commands);
/// What vkCmdFillBuffer wrote is read and written by compute shaders.
void fillToComputeReadWrite(VkCommandBuffer commands);
/// A compute shader's buffers are read, or written again, by the next one.
void computeWriteToComputeReadWrite(VkCommandBuffer commands);
/// A compute shader's buffers are copied to the host.
void computeWriteToCopy(VkCommandBuffer commands);
/// What was copied is read by the host after the fence.
void copyToHost(VkCommandBuffer commands);
/// Depth that a render pass left in SHADER_READ_ONLY layout is copied; the layout changes to TRANSFER_SRC.
void sampledDepthToCopy(VkCommandBuffer commands, VkImage image);

/// A depth image's contents are given up; its layout becomes SHADER_READ_ONLY, before compute shaders and whatever
/// waits for them.
void undefinedToSampledDepth(VkCommandBuffer commands, VkImage image);
/// Profiling runs only: everything before has ended before anything after begins.
void everythingToEverything(VkCommandBuffer commands);

}  // namespace radar::gpu
