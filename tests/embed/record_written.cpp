#include <radar/recorder.h>
#include <vulkan/vulkan.h>

// What a renderer's compute shader asks. The buffers have VK_BUFFER_USAGE_TRANSFER_SRC_BIT.
struct Asked {
  VkBuffer queries;  // RadarQuery queries[256]: radar/query.glsl
  VkBuffer number;   // uint, how many of them there are
};

// Called once per frame, after that shader has been recorded.
void recordAsked(VkCommandBuffer commands, radar::Recorder& recorder, const Asked& asked) {
  VkMemoryBarrier2 askedToCopy{};
  askedToCopy.sType = VK_STRUCTURE_TYPE_MEMORY_BARRIER_2;
  askedToCopy.srcStageMask = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT;
  askedToCopy.srcAccessMask = VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;
  askedToCopy.dstStageMask = VK_PIPELINE_STAGE_2_COPY_BIT;
  askedToCopy.dstAccessMask = VK_ACCESS_2_TRANSFER_READ_BIT;
  VkDependencyInfo info{};
  info.sType = VK_STRUCTURE_TYPE_DEPENDENCY_INFO;
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &askedToCopy;
  vkCmdPipelineBarrier2(commands, &info);
  recorder.record(commands, radar::HostQueries{.buffer = asked.queries, .count = 256, .countBuffer = asked.number});
}
