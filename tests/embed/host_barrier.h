// The barrier of hosts, as docs/embedding.md has it.
#pragma once

#include <vulkan/vulkan.h>

#include "radar/recorder.h"

namespace radar::test {

inline constexpr Access kShaderReads{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT};

/// What was recorded before and accesses memory as `first` happens before what is recorded later and does as `then`.
inline void barrier(VkCommandBuffer commands, Access first, Access then) {
  const VkMemoryBarrier2 memory{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                .srcStageMask = first.stages,
                                .srcAccessMask = first.access,
                                .dstStageMask = then.stages,
                                .dstAccessMask = then.access};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &memory};
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace radar::test
