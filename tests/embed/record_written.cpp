#include <radar/recorder.h>

#include "after_shaders.h"

// What a renderer's compute shader asks. The buffers have radar::kHostBufferUsage.
struct Asked {
  VkBuffer queries;  // RadarQuery queries[256]: radar/query.glsl
  VkBuffer number;   // uint, how many of them there are
};

// Called once per frame, after that shader has been recorded.
void recordAsked(VkCommandBuffer commands, radar::Recorder& recorder, const Asked& asked) {
  afterShaders(commands, radar::Recorder::kReads);
  recorder.record(commands, radar::HostQueries{.buffer = asked.queries, .count = 256, .countBuffer = asked.number});
}
