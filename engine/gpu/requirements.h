// What a physical device must have, in one list: read by the check that gives reasons, and by requirements().
#pragma once

#include <string>
#include <vector>

#include "gpu/api.h"

namespace radar::gpu {

/// What the engine looks at of a physical device; filled from Vulkan, or by a test.
struct SubgroupFacts {
  uint32_t size = 0;       ///< that full subgroups get: the device's own, or less where that is large and can be chosen
  bool canChoose = false;  ///< a compute pipeline may ask for a size
  bool isFixed = false;    ///< all subgroups of compute pipelines have `size` invocations, or can be made to
  bool ballots = false;    ///< votes and ballots in compute shaders
};
SubgroupFacts subgroupFactsOf(const Api& vk, VkPhysicalDevice device);

struct DeviceFacts {
  uint32_t apiVersion = 0;
  uint32_t maxLayers = 0;
  uint32_t subPixelBits = 0;
  uint32_t groupInvocations = 0;
  uint32_t stageBuffers = 0;
  uint32_t sharedBytes = 0;
  SubgroupFacts subgroups;
  bool graphicsAndComputeQueue = false;
  bool doubles = false;  ///< shaderFloat64: not required
  std::vector<std::string> missingFeatures;
};

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device);

/// Shared memory that a workgroup of the search needs at least (shaders/contact/search.comp.glsl): 6 entries of both
/// queues for each lane, and a task.
constexpr uint32_t searchSharedBytes(uint32_t lanes, uint32_t queue = 0) {
  return (queue != 0 ? queue : 6 * lanes) * 36 + lanes * 20;
}

/// One line per thing that is missing; empty if the device will do.
std::vector<std::string> reasonsAgainst(const DeviceFacts& facts);

}  // namespace radar::gpu
