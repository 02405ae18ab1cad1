// A host's allocator of device memory for tests.
#pragma once

#include "radar/device.h"

namespace radar::test {

/// Gives each buffer and image an allocation of its own, which can fail and begins with garbage (watched_vulkan.h).
/// `host`: instance, devices and loader.
HostMemory separateAllocations(const HostDevice& host);

}  // namespace radar::test
