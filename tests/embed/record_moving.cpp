#include <span>

#include <radar/recorder.h>
#include <vulkan/vulkan.h>

// Once a frame, behind the host's compute shaders that skin and animate: what they wrote into the buffers of `geometry`
// is what the queries meet.
void recordMoving(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries,
                  const radar::HostGeometry& geometry) {
  const VkMemoryBarrier2 movedToCopy{.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2,
                                     .srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                     .srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT,
                                     .dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT,
                                     .dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT};
  const VkDependencyInfo info{
      .sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO, .memoryBarrierCount = 1, .pMemoryBarriers = &movedToCopy};
  vkCmdPipelineBarrier2(commands, &info);
  recorder.record(commands, queries, geometry);
}
