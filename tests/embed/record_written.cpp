#include <radar/recorder.h>

#include "after_shaders.h"

// What a renderer's compute shader asks. The buffers have VK_BUFFER_USAGE_TRANSFER_SRC_BIT.
struct Asked {
  VkBuffer queries;  // RadarQuery queries[256]: radar/query.glsl
  VkBuffer number;   // uint, how many of them there are
};

// Called once per frame, after that shader has been recorded.
void recordAsked(VkCommandBuffer commands, radar::Recorder& recorder, const Asked& asked) {
  afterShaders(commands, VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_READ_BIT);
  recorder.record(commands, radar::HostQueries{.buffer = asked.queries, .count = 256, .countBuffer = asked.number});
}
