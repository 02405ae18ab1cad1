// Frames of a host in which an engine records.
#pragma once

#include "embed/host.h"
#include "support/catch.h"
#include "support/watched_vulkan.h"

namespace radar::test {

/// Makes Frames(engine, hosts) of the engine's device and the host's own use of it, and calls it with the number of
/// each frame. The engine must submit nothing and wait for nothing then, allocate nothing from frame `warm` on, and
/// leave nothing.
template <class Frames>
void checkQuiet(uint32_t count, uint32_t warm) {
  Host host;
  const Device hosts = host.own();
  host.handles.allocator = countingAllocator();
  {
    const Device engine = Device::adopt(host.handles);
    Frames frames(engine, hosts);
    const auto loud = [] { return callsOf("vkQueueSubmit2") + callsOf("vkWaitForFences"); };
    const uint64_t before = loud();
    int64_t allocated = 0;
    for (uint32_t number = 0; number < count; ++number) {
      if (number == warm) allocated = allocations().all;
      frames(number);
    }
    CHECK(allocations().all == allocated);
    CHECK(loud() == before);
  }
  CHECK(allocations().live == 0);
}

}  // namespace radar::test
