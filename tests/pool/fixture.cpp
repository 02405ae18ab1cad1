#include "pool/fixture.h"

#include "gpu/device.h"
#include "support/same_bits.h"
#include "support/test_device.h"

namespace radar::test {

namespace {

struct FaultyDevices {
  std::vector<Device> devices = openDevices({}, onValidation);
  std::array<Faults, 2> faults;
  std::array<gpu::Api, 2> calls{devices.at(0).impl().vk, devices.at(1).impl().vk};  // the driver's
};

FaultyDevices& faultyDevices() {
  return test::onceInRun([] { return FaultyDevices(); });
}

// The device that has this handle.
template <class HandleOf>
size_t deviceWith(const HandleOf& isOf) {
  return isOf(faultyDevices().devices[0].handles()) ? 0 : 1;
}

// These stand for the driver's functions.

VkResult allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks* allocator,
                        VkDeviceMemory* memory) {
  const size_t i = deviceWith([&](const HostDevice& host) { return host.device == device; });
  const VkResult fault = faultyDevices().faults[i].resultOf("vkAllocateMemory");
  return fault != VK_SUCCESS ? fault : faultyDevices().calls[i].AllocateMemory(device, info, allocator, memory);
}

VkResult queueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence) {
  const size_t i = deviceWith([&](const HostDevice& host) { return host.queue == queue; });
  const VkResult fault = faultyDevices().faults[i].resultOf("vkQueueSubmit2");
  return fault != VK_SUCCESS ? fault : faultyDevices().calls[i].QueueSubmit2(queue, count, submits, fence);
}

VkResult waitForFences(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout) {
  const size_t i = deviceWith([&](const HostDevice& host) { return host.device == device; });
  const VkResult waited = faultyDevices().calls[i].WaitForFences(device, count, fences, all, timeout);
  const VkResult fault = faultyDevices().faults[i].resultOf("vkWaitForFences");
  return fault != VK_SUCCESS ? fault : waited;
}

void replaceCalls() {
  for (const Device& device : faultyDevices().devices) {
    gpu::Api& vk = device.impl().vk;
    vk.AllocateMemory = allocateMemory;
    vk.QueueSubmit2 = queueSubmit;
    vk.WaitForFences = waitForFences;
  }
}

}  // namespace

void Faults::failFrom(std::string_view call, int n, VkResult result) {
  const std::lock_guard lock(mutex_);
  call_ = call;
  left_ = n;
  result_ = result;
}

void Faults::clear() {
  failFrom("", 0, VK_SUCCESS);
}

void Faults::hold() {
  const std::lock_guard lock(mutex_);
  holding_ = true;
}

void Faults::release() {
  {
    const std::lock_guard lock(mutex_);
    holding_ = false;
  }
  changed_.notify_all();
}

void Faults::awaitHeld() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [&] { return held_ > 0; });
}

VkResult Faults::resultOf(std::string_view call) {
  std::unique_lock lock(mutex_);
  if (call == "vkWaitForFences" && holding_) {
    ++held_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !holding_; });
    --held_;
  }
  if (call != call_) return VK_SUCCESS;
  return left_-- > 0 ? VK_SUCCESS : result_;
}

std::span<const Device> twoDevices() {
  static std::once_flag once;
  std::call_once(once, replaceCalls);
  return faultyDevices().devices;
}

Faults& faults(size_t device) {
  return faultyDevices().faults[device];
}

Boxes::Boxes(uint32_t sensors, uint32_t boxes)
    : workload(tools::makeWorkload(
          tools::Table1{.boxes = boxes, .sensors = sensors, .shape = tools::SensorShape::box, .seed = 31})),
      player(workload) {
  player.show(0);
  queries = tools::queriesOf(workload.queries, 16);
}

std::vector<Result> Boxes::answers(Mode mode) const {
  Sweeper sweeper(twoDevices()[0], player.scene(), kOnDevice);
  return sweeper.run(queries, mode).results;
}

size_t differences(std::span<const Result> a, std::span<const Result> b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += !sameBits(a[i], b[i]);
  return count;
}

}  // namespace radar::test
