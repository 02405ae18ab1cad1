#include <span>

#include <radar/recorder.h>
#include <vulkan/vulkan.h>

// Once a frame, outside a render pass: the queries' answers are ready for the host's compute shaders behind it.
// `recorder` is this frame in flight's own; what it recorded before has been executed and waited for.
void recordQueries(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries) {
  recorder.record(commands, queries);
  const VkMemoryBarrier2 answersToShaders{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                          .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                          .dstStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                          .dstAccessMask = VK_ACCESS_2_SHADER_STORAGE_READ_BIT};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &answersToShaders};
  vkCmdPipelineBarrier2(commands, &info);
}
