// One request after the other fails, of the device's functions or for host memory.
#pragma once

#include <new>

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

struct Attempt {
  bool failed = false;        ///< there were enough requests for one to fail
  bool threw = false;         ///< because of it: std::bad_alloc, or an Error that names the function
  std::string function = "";  ///< of the device, that failed
};

/// Makes request number `n` of a call fail.
template <class Call>
Attempt attempt(Of of, int64_t n, const Call& call) {
  Attempt made;
  if (of == Of::device) {
    const VulkanFault fault(n, shortage(n), VulkanFault::When::once);
    try {
      call();
    } catch (const Error& error) {
      made.threw = true;
      CHECK(error.vulkan == shortage(n));
      CHECK_THAT(error.what(), Contains(fault.failed()));
    }
    made.failed = fault.happened();
    made.function = fault.failed();
    return made;
  }
  {
    const EngineWork counting;
    host_memory::failAt(n);
    try {
      call();
    } catch (const std::bad_alloc&) {
      made.threw = true;
    }
  }
  made.failed = host_memory::requests() > n;
  host_memory::failAt(-1);
  return made;
}

/// Calls attemptAt(0), attemptAt(1), ... until no request was left to fail; returns how many failed.
template <class AttemptAt>
int64_t failEach(const AttemptAt& attemptAt) {
  for (int64_t n = 0;; ++n) {
    CAPTURE(n);
    const Attempt made = attemptAt(n);
    CHECK(made.failed >= made.threw);
    if (!made.failed) return n;
  }
}

}  // namespace radar::test
