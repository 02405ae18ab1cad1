// Prints how much memory a Recorder and a Sweeper hold, by the number of queries and the kind of the device.
#include <cstdio>
#include <exception>

#include "commit/commit.h"
#include "radar/radar.h"
#include "support/held_memory.h"
#include "support/pretended_gpu.h"

namespace {

void print(const radar::test::HeldMemory& held) {
  std::printf(" %.2f + %.2f |", held.ofDevice / 1e6, held.ofHost / 1e6);
  std::fflush(stdout);
}

}  // namespace

int main() try {
  using namespace radar;
  const Device device = Device::open();
  const test::CountedDevice cpu(device.handles()), gpu(test::asGpu(device.handles()));
  std::printf(
      "device %s, commit %s; megabytes of the device's and of the host's memory\n\n"
      "| queries | Recorder, on a CPU | on a GPU | on a GPU, 32 lanes | Sweeper, on a CPU | on a GPU |\n"
      "|--:|--:|--:|--:|--:|--:|\n",
      device.name().c_str(), tools::commit());
  for (const uint32_t queries : {1u, 64u, 1000u, 10'000u, 100'000u}) {
    std::printf("| %u |", queries);
    print(cpu.heldByRecorder(queries));
    print(gpu.heldByRecorder(queries));
    print(gpu.heldByRecorder(queries, 32));
    print(cpu.heldBySweeper(queries));
    print(gpu.heldBySweeper(queries));
    std::printf("\n");
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar_memory: %s\n", error.what());
  return 2;
}
