// One request after the other fails, of the device's functions or for host memory.
#pragma once

#include "faults/host_memory.h"
#include "radar/device.h"
#include "support/catch.h"
#include "support/watched_vulkan.h"

namespace radar::test {

enum class Of { device, host };

/// What a call of the device's functions that fails says.
inline VkResult shortage(int64_t n) {
  return n % 2 == 0 ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_ERROR_OUT_OF_HOST_MEMORY;
}

/// Makes request number `n` of a call fail; it may throw an Error then that names the function, or std::bad_alloc.
template <class Call>
Attempt attempt(Of of, int64_t n, const Call& call) {
  if (of == Of::host) return attemptWithoutMemory(n, call);
  Attempt made;
  const VulkanFault fault(n, shortage(n), VulkanFault::When::once);
  try {
    call();
  } catch (const Error& error) {
    made.threw = true;
    CHECK(error.vulkan == shortage(n));
    const bool isHosts = fault.failed() == "vkAllocateMemory" || fault.failed() == "vkMapMemory";
    CHECK_THAT(error.what(), Contains(isHosts ? "HostMemory::allocate" : fault.failed()));
  }
  made.failed = fault.happened();
  made.function = fault.failed();
  return made;
}

/// Calls attemptAt(0), attemptAt(1), ... until no request was left to fail; returns how many failed.
template <class AttemptAt>
int64_t failEach(const AttemptAt& attemptAt) {
  for (int64_t n = 0;; ++n) {
    CAPTURE(n);
    Attempt made = attemptAt(n);
    CHECK(made.failed >= made.threw);
    if (!made.failed) return n;
  }
}

}  // namespace radar::test
