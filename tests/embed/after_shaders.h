#pragma once

#include <radar/recorder.h>
#include <vulkan/vulkan.h>

// Commands with that access, recorded after this, see what compute shaders have written before.
inline void afterShaders(VkCommandBuffer commands, radar::Access then) {
  VkMemoryBarrier2 barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  barrier.srcStageMask = radar::Recorder::kWrites.stages;
  barrier.srcAccessMask = radar::Recorder::kWrites.access;
  barrier.dstStageMask = then.stages;
  barrier.dstAccessMask = then.access;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}
