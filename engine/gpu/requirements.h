// What a physical device must have, in one list: read by the check that gives reasons, and by requirements().
#pragma once

#include <string>
#include <vector>

#include "gpu/api.h"
#include "radar/radar.h"

namespace radar::gpu {

/// What the engine looks at of a physical device; filled from Vulkan, or by a test.
struct SubgroupFacts {
  uint32_t size = 0;       ///< that full subgroups get: the device's own, or less where that is large and can be chosen
  bool canChoose = false;  ///< a compute pipeline may ask for a size
  bool isFixed = false;    ///< all subgroups of compute pipelines have `size` invocations, or can be made to
  bool ballots = false;    ///< votes and ballots in compute shaders
};
SubgroupFacts subgroupFactsOf(const Api& vk, VkPhysicalDevice device);

struct MissingFeature {
  std::string text;  ///< its name, and in brackets what it is for
  Mode mode;         ///< the least mode that needs it: sampled needs all of contact's
};

struct DeviceFacts {
  uint32_t apiVersion = 0;
  bool computeQueue = false;             ///< a queue family does compute
  bool graphicsAndComputeQueue = false;  ///< a queue family does both
  SubgroupFacts subgroups;
  bool doubles = false;  ///< shaderFloat64: not required
  std::vector<MissingFeature> missingFeatures;
  std::vector<DeviceLimit> limits;
};

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device);

/// Every limit that the shaders rely on.
std::vector<DeviceLimit> limitsOf(const VkPhysicalDeviceLimits& limits, const SubgroupFacts& subgroups);

/// Shared memory that a workgroup of the search needs at least (shaders/contact/search.comp.glsl): 6 entries of both
/// queues for each lane, and a task.
constexpr uint32_t searchSharedBytes(uint32_t lanes, uint32_t queue = 0) {
  return (queue != 0 ? queue : 6 * lanes) * 36 + lanes * 20;
}

/// "1.3.224".
std::string versionText(uint32_t version);

/// One line per thing that is missing for `mode`; empty if the device will do.
std::vector<std::string> reasonsAgainst(const DeviceFacts& facts, Mode mode);

/// The queue family to use, or kNone: the first that does graphics and compute; if none does, the first that does
/// compute.
uint32_t queueFamilyOf(const Api& vk, VkPhysicalDevice device);

/// Whether the queue family does graphics, too.
bool doesGraphics(const Api& vk, VkPhysicalDevice device, uint32_t family);

}  // namespace radar::gpu
