// The requirements on a physical device, in one list for both unsupportedReasons() and requirements().
#pragma once

#include <string>
#include <vector>

#include "gpu/api.h"
#include "radar/device.h"

namespace radar::gpu {

/// The properties of a physical device that matter to the engine; filled from Vulkan, or by a test.
struct SubgroupFacts {
  uint32_t size = 0;       ///< of full subgroups: the device's own, or less if that is large and can be chosen
  bool canChoose = false;  ///< a compute pipeline may request a size
  bool isFixed = false;    ///< all subgroups of compute pipelines have `size` invocations, or can be made to
  bool ballots = false;    ///< votes and ballots in compute shaders
};
SubgroupFacts subgroupFactsOf(const Api& vk, VkPhysicalDevice device);

struct MissingFeature {
  std::string text;     ///< its name, with its purpose in brackets
  bool isOf13 = false;  ///< every device of Vulkan 1.3 has it, but no instance of an older version shows it
};

struct DeviceFacts {
  uint32_t apiVersion = 0;
  bool computeQueue = false;             ///< a queue family supports compute
  bool graphicsAndComputeQueue = false;  ///< a queue family supports both
  SubgroupFacts subgroups;
  bool doubles = false;      ///< shaderFloat64: not required
  bool outputLayer = false;  ///< shaderOutputLayer: not required
  std::vector<MissingFeature> missingFeatures;
  std::vector<DeviceLimit> limits;
};

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device);

/// Every limit that the shaders rely on.
std::vector<DeviceLimit> limitsOf(const VkPhysicalDeviceLimits& limits, const SubgroupFacts& subgroups);

/// "1.3.224".
std::string versionText(uint32_t version);

/// What a device must have enabled, and these two optional features.
Requirements requirements(bool doubles, bool outputLayer);

/// One line per item missing for `mode`; empty if the device is usable.
std::vector<std::string> unsupportedReasons(const DeviceFacts& facts, Mode mode);

/// The queue family to use: the first with graphics and compute, else the first with compute, else kNone.
uint32_t queueFamilyOf(const Api& vk, VkPhysicalDevice device);

/// What the queue family supports; 0 if there is no such family.
VkQueueFlags queueFlagsOf(const Api& vk, VkPhysicalDevice device, uint32_t family);

}  // namespace radar::gpu
