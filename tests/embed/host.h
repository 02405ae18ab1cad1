// A miniature host: it owns instance, device and queue, and its loader counts the calls that the engine makes.
#pragma once

#include <set>
#include <string>

#include "radar/radar.h"

namespace radar::test {

class Host {
 public:
  /// Enables what `mode` requires and nothing else, on physical device `index`.
  explicit Host(Mode mode = Mode::sampled, uint32_t index = 0);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  HostDevice handles;

 private:
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// What engines have done through countingLoader() and countingAllocator() since resetCounts().
struct Counts {
  std::set<std::string> lookedUp;          ///< names of functions
  int64_t allocations = 0, live = 0;       ///< of host memory through the callbacks
  uint64_t submissions = 0, waits = 0;     ///< vkQueueSubmit2, vkWaitForFences
  VkPipelineCache cache = VK_NULL_HANDLE;  ///< of the last compute pipeline created
};
Counts counts();
void resetCounts();
PFN_vkGetInstanceProcAddr countingLoader();
const VkAllocationCallbacks* countingAllocator();

}  // namespace radar::test
