#include <span>

#include <radar/recorder.h>
#include <vulkan/vulkan.h>

// Called once per frame, outside a render pass. Compute shaders that the host records afterwards can read the answers.
// Each frame in flight has its own `recorder`, whose previous recording has executed and been waited for.
void recordQueries(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries) {
  recorder.record(commands, queries);
  VkMemoryBarrier2 answersToShaders{};
  answersToShaders.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  answersToShaders.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  answersToShaders.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  answersToShaders.dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  answersToShaders.dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &answersToShaders;
  vkCmdPipelineBarrier2(commands, &info);
}
