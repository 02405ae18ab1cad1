#include "support/held_memory.h"

#include "gpu/device.h"
#include "radar/radar.h"
#include "radar/recorder.h"
#include "support/separate_allocations.h"
#include "support/world.h"
#include "workloads/generate.h"

namespace radar::test {

namespace {

HeldMemory operator-(const HeldMemory& a, const HeldMemory& b) {
  return {a.ofDevice - b.ofDevice, a.ofHost - b.ofHost};
}

}  // namespace

CountedDevice::CountedDevice(HostDevice host) {
  host.memory = separateAllocations(host);
  host.memory.allocate = [this, give = host.memory.allocate](const MemoryRequest& request, MemoryPiece& piece) {
    const VkResult result = give(request, piece);
    const bool isHosts = (request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    if (result == VK_SUCCESS) pieces_[piece.memory] = {isHosts, request.requirements.size};
    return result;
  };
  host.memory.free = [this, take = host.memory.free](const MemoryPiece& piece) {
    pieces_.erase(piece.memory);
    take(piece);
  };
  device_.emplace(Device::adopt(host));
  prepare(*device_);
}

HeldMemory CountedDevice::held() const {
  HeldMemory held;
  for (const auto& [memory, piece] : pieces_) (piece.isHosts ? held.ofHost : held.ofDevice) += piece.bytes;
  return held;
}

HeldMemory CountedDevice::heldByRecorder(uint32_t queries, uint32_t lanes) const {
  Device::Impl& device = device_->impl();
  const uint32_t own = device.subgroupSize;
  const bool chooses = device.choosesSubgroupSize;
  if (lanes != 0) {
    device.subgroupSize = lanes;
    device.choosesSubgroupSize = false;  // nothing runs, and the driver cannot give as many
  }
  const HeldMemory before = held();
  const Scene scene;
  const Recorder recorder(*device_, scene, {.queries = queries});
  device.subgroupSize = own;
  device.choosesSubgroupSize = chooses;
  return held() - before;
}

HeldMemory CountedDevice::heldBySweeper(uint32_t queries) const {
  const Case boxes =
      caseOf(tools::makeWorkload(tools::Table1{.boxes = 1000, .sensors = queries, .shape = tools::SensorShape::box}));
  const HeldMemory before = held();
  Sweeper sweeper(*device_, boxes.scene, {.cpuBatch = 0});
  sweeper.run(boxes.queries);
  return held() - before;
}

}  // namespace radar::test
