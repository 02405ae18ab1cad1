// What a physical device must have, in one list: read by the check that gives reasons, and by the one that enables it.
#pragma once

#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

namespace radar::gpu {

/// The features of Vulkan 1.0 to 1.3, chained. Not movable: the structs point at each other.
struct Features {
  Features();
  Features(const Features&) = delete;
  Features& operator=(const Features&) = delete;
  VkPhysicalDeviceVulkan13Features v13{};
  VkPhysicalDeviceVulkan12Features v12{};
  VkPhysicalDeviceFeatures2 core{};
};

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

DeviceFacts factsOf(VkPhysicalDevice device);

/// One line per thing that is missing; empty if the device will do.
std::vector<std::string> reasonsAgainst(const DeviceFacts& facts);

/// Switches on every required feature, and shaderFloat64 where `doubles`.
void enableRequired(Features& features, bool doubles);

}  // namespace radar::gpu
