#include <span>

#include <radar/recorder.h>

#include "after_shaders.h"

// Called once per frame, outside a render pass. Compute shaders that the host records afterwards can read the answers.
// Each frame in flight has its own `recorder`, whose previous recording has executed and been waited for.
void recordQueries(VkCommandBuffer commands, radar::Recorder& recorder, std::span<const radar::Query> queries) {
  recorder.record(commands, queries);
  afterShaders(commands, {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT});
}
