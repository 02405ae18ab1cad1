// A miniature host: it owns instance, device and queue, and its loader watches the calls that the engine makes.
#pragma once

#include "radar/radar.h"

namespace radar::test {

class Host {
 public:
  /// Enables what `mode` requires and nothing else, on number `index` of the tested devices (support/test_device.h);
  /// beyond the last, on the first again. Gives separateAllocations().
  explicit Host(Mode mode = Mode::sampled, uint32_t index = 0);
  ~Host();
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;
  /// Its own use of the device, which does not pass the loader that watches.
  Device own() const;
  /// Without its allocator of memory: the engine's own is used.
  HostDevice withoutMemory() const;

  HostDevice handles;

 private:
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};

/// A host's device that the engine uses, for tests that need no host of their own.
const Device& watchedDevice();

/// Counts what engines allocate through it.
const VkAllocationCallbacks* countingAllocator();
/// So far, and not yet freed.
struct Allocations {
  int64_t all = 0, live = 0;
};
Allocations allocations();

}  // namespace radar::test
