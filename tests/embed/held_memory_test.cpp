// Memory is sized by the queries, as Capacity says, whatever kind of device it is.
#include "support/held_memory.h"

#include <algorithm>

#include "support/catch.h"
#include "support/pretended_gpu.h"
#include "support/test_device.h"

namespace {

using namespace radar;
using test::HeldMemory;

/// The formula of radar/recorder.h.
HeldMemory mostFor(uint64_t queries, bool doubles) {
  const uint64_t some = std::clamp<uint64_t>(queries, 64, 1000) - 64, more = std::max<uint64_t>(queries, 1000) - 1000;
  const uint64_t first = 8'000'000 + 25'600 * some;
  return {first + 1000 * more, first + (doubles ? 800 : 3700) * more};
}

void check(const HeldMemory& held, const HeldMemory& most, uint32_t queries) {
  CHECK(held.ofDevice <= most.ofDevice);
  CHECK(held.ofHost <= most.ofHost);
  if (queries <= 1000) CHECK(held.all() <= most.ofDevice);
}

}  // namespace

TEST_CASE("a Recorder takes no more memory than Capacity says, on a CPU and on a GPU, and so does a Sweeper") {
  const HostDevice& handles = test::device().handles();
  const bool doubles = test::device().doubles(), isGpu = GENERATE(false, true);
  const test::CountedDevice device(isGpu ? test::asGpu(handles) : handles);
  for (const uint32_t queries : {1u, 64u, 65u, 256u, 1000u, 2100u, 10'000u, 100'000u}) {
    CAPTURE(isGpu, queries);
    const HeldMemory most = mostFor(queries, doubles);
    for (const uint32_t lanes : isGpu ? std::vector{0u, 32u, 64u} : std::vector{0u, 16u}) {
      CAPTURE(lanes);
      check(device.heldByRecorder(queries, lanes), most, queries);
    }
    if (queries <= 10'000) check(device.heldBySweeper(queries), most, queries);
  }
}
