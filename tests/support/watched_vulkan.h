// The Vulkan functions that the engine calls, through a loader that stands before the system's: a test counts calls,
// delays some or makes them fail, and sees what the engine has left behind.
#pragma once

#include <string>
#include <string_view>

#include "radar/device.h"

namespace radar::test {

/// The loader, for HostDevice::getInstanceProcAddr. Labels are counted, but reach no driver (DeviceOptions::debugNames
/// says why).
PFN_vkGetInstanceProcAddr watchedLoader();

/// Whether an engine has looked a function up since the program began.
bool isLookedUp(const std::string& name);
/// Calls of a function since the program began.
uint64_t callsOf(const std::string& name);
/// Of the last compute pipeline created.
VkPipelineCache lastPipelineCache();
/// Bytes of device memory that engines have allocated since the program began.
uint64_t allocatedDeviceBytes();
/// Objects and allocations of a device that engines have created and not destroyed.
int64_t liveVulkanObjects();

/// Which calls may fail. Only those that return a VkResult do.
struct FailingCalls {
  const HostDevice* device = nullptr;  ///< whose; null: every device's
  std::string_view name = {};          ///< of which function; empty: of all
};

/// Makes calls fail while it lives; one lives at a time.
class VulkanFault {
 public:
  enum class When {
    once,    ///< that call
    lost,    ///< it, and all later submissions, waits and readings of timestamps: those that report a lost device
    onwards  ///< it, and all later calls
  };
  /// Call number `n` from now on (0: the next) gives `result`, and does nothing; but a wait still waits if the device
  /// is lost. `lost` counts only calls that report a lost device.
  VulkanFault(int64_t n, VkResult result, When when, const FailingCalls& calls = {});
  ~VulkanFault();
  VulkanFault(const VulkanFault&) = delete;
  VulkanFault& operator=(const VulkanFault&) = delete;

  /// Whether that call was made.
  bool happened() const;
  /// The function that failed first.
  std::string failed() const;
};

/// While one lives and until release(), devices do not come back from vkWaitForFences.
class HeldWaits {
 public:
  HeldWaits();
  ~HeldWaits() { release(); }
  HeldWaits(const HeldWaits&) = delete;
  HeldWaits& operator=(const HeldWaits&) = delete;

  /// Until so many waits are held.
  void await(int count);
  void release();
};

/// While one lives, submissions and waits take turns: if one thread submits while another waits, synchronization
/// validation sometimes misses the wait and reports false hazards.
class CallsInTurn {
 public:
  CallsInTurn();
  ~CallsInTurn();
  CallsInTurn(const CallsInTurn&) = delete;
  CallsInTurn& operator=(const CallsInTurn&) = delete;
};

/// While one lives, shader modules and pipelines are not made: their handles name nothing. For tests that create many
/// and run none.
class HollowPipelines {
 public:
  HollowPipelines();
  ~HollowPipelines();
  HollowPipelines(const HollowPipelines&) = delete;
  HollowPipelines& operator=(const HollowPipelines&) = delete;
};

/// While one lives, labels reach the driver.
class TrueLabels {
 public:
  TrueLabels();
  ~TrueLabels();
  TrueLabels(const TrueLabels&) = delete;
  TrueLabels& operator=(const TrueLabels&) = delete;
};

}  // namespace radar::test
