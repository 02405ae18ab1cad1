#include "pool/fixture.h"

#include <cstring>

#include "gpu/device.h"
#include "support/test_device.h"

namespace radar::test {

namespace {

struct Opened {
  Opened() {
    if (devices.size() != 2) throw std::runtime_error("expected two devices, as ctest's environment gives");
    for (size_t i = 0; i < devices.size(); ++i) {
      devices[i].impl().fault = [this, i](std::string_view call) { return faults[i].answer(call); };
    }
  }
  std::vector<Device> devices = openDevices({}, onValidation);
  std::array<Faults, 2> faults;
};

Opened& opened() {
  static Opened both;
  return both;
}

}  // namespace

void Faults::failFrom(std::string_view call, int n, VkResult result) {
  const std::lock_guard lock(mutex_);
  call_ = call;
  left_ = n;
  result_ = result;
}

void Faults::mend() {
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

VkResult Faults::answer(std::string_view call) {
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
  return opened().devices;
}

Faults& faults(size_t device) {
  return opened().faults[device];
}

Boxes::Boxes(uint32_t sensors, uint32_t boxes)
    : workload(tools::makeWorkload(
          tools::Table1{.boxes = boxes, .sensors = sensors, .shape = tools::SensorShape::box, .seed = 31})),
      player(workload) {
  player.show(0);
  for (const tools::QuerySpec& spec : workload.queries) {
    queries.push_back(tools::toQuery(spec, queries.size() % 3 == 0 ? Mode::sampled : Mode::contact, 16));
  }
}

std::vector<Result> Boxes::answers() const {
  Sweeper sweeper(twoDevices()[0], player.scene(), kOnDevice);
  return sweeper.run(queries);
}

size_t differences(std::span<const Result> a, std::span<const Result> b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  size_t count = 0;
  for (size_t i = 0; i < a.size(); ++i) count += std::memcmp(&a[i], &b[i], sizeof(Result)) != 0;
  return count;
}

}  // namespace radar::test
