// Devices whose Vulkan calls and requests for memory a test can make fail.
#pragma once

#include "embed/host.h"
#include "faults/host_memory.h"
#include "faults/vulkan_calls.h"

namespace radar::test {

/// A host whose device the engine reaches through faultyLoader().
struct FaultyHost : Host {
  explicit FaultyHost(uint32_t index = 0, Mode mode = Mode::sampled) : Host(mode, index) {
    handles.getInstanceProcAddr = faultyLoader();
    handles.debugNames = true;
  }
};

/// One, and its device, for tests that need no other.
struct Adopted {
  FaultyHost host;
  Device device = Device::adopt(host.handles);
};
inline Adopted& adopted() {
  static Adopted one;
  return one;
}

}  // namespace radar::test
