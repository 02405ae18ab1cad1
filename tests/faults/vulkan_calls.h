// The Vulkan functions that the engine calls, through a loader that stands before the system's: a test makes the n-th
// call fail, and sees what the engine has left behind.
#pragma once

#include <atomic>
#include <string>

#include "radar/device.h"

namespace radar::test {

/// The loader, for HostDevice::getInstanceProcAddr. Calls count only while a VulkanFault or VulkanLeaks lives.
PFN_vkGetInstanceProcAddr faultyLoader();

/// Makes calls fail while it lives; one lives at a time. Calls that may fail are those that return a VkResult.
class VulkanFault {
 public:
  enum class When {
    once,    ///< that call
    lost,    ///< it, and all later submissions, waits and readings of timestamps: those that report a lost device
    onwards  ///< it, and all later calls
  };
  /// Call number `n` from now on (0: the next) gives `result`, and does nothing; but a wait still waits if the device
  /// is lost. `lost` counts only calls that report a lost device. `device`: only its calls; null: every device's.
  VulkanFault(int64_t n, VkResult result, When when, VkDevice device = VK_NULL_HANDLE, VkQueue queue = VK_NULL_HANDLE);
  ~VulkanFault();
  VulkanFault(const VulkanFault&) = delete;
  VulkanFault& operator=(const VulkanFault&) = delete;

  /// Whether that call was made.
  bool happened() const;
  /// The function that failed first.
  std::string failed() const;
};

/// Objects and allocations of a device that engines have created and not destroyed.
int64_t liveVulkanObjects();

/// While one lives, shader modules and pipelines are not made: their handles name nothing. For tests that create many
/// and run none.
class HollowPipelines {
 public:
  HollowPipelines();
  ~HollowPipelines();
  HollowPipelines(const HollowPipelines&) = delete;
  HollowPipelines& operator=(const HollowPipelines&) = delete;
};

}  // namespace radar::test
