// What a physical device must have, in one list: read by the check that gives reasons, and by requirements().
#pragma once

#include <string>
#include <vector>

#include "gpu/api.h"

namespace radar::gpu {

/// What the engine looks at of a physical device; filled from Vulkan, or by a test.
struct DeviceFacts {
  uint32_t apiVersion = 0;
  uint32_t maxLayers = 0;
  uint32_t subPixelBits = 0;
  uint32_t groupInvocations = 0;
  uint32_t stageBuffers = 0;
  bool graphicsAndComputeQueue = false;
  bool doubles = false;  ///< shaderFloat64: not required
  std::vector<std::string> missingFeatures;
};

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device);

/// One line per thing that is missing; empty if the device will do.
std::vector<std::string> reasonsAgainst(const DeviceFacts& facts);

}  // namespace radar::gpu
