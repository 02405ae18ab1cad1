// Two devices whose calls a test can delay or make fail, and queries for them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "radar/pool.h"
#include "workloads/generate.h"

namespace radar::test {

/// Faults in the calls of a device. May be changed while the device works.
class Faults {
 public:
  /// The `n`-th of these calls from now (0: the next) and all later ones return `result`.
  void failFrom(std::string_view call, int n, VkResult result);
  void clear();
  /// Blocks the device in vkWaitForFences until release().
  void hold();
  void release();
  /// Waits until the device is blocked.
  void awaitHeld();
  VkResult resultOf(std::string_view call);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string call_;
  int left_ = 0;
  VkResult result_ = VK_SUCCESS;
  bool holding_ = false;
  int held_ = 0;
};

/// Sends queries of mode contact to the devices, however few they are.
inline constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

/// Opened on first use. Messages of the validation layers go to onValidation().
std::span<const Device> twoDevices();
/// The faults of one of these devices. A test that sets faults clears them.
Faults& faults(size_t device);

/// A scene of boxes and the queries of its sensors.
struct Boxes {
  explicit Boxes(uint32_t sensors, uint32_t boxes = 2'000);
  /// The answers of a plain sweeper on the first device.
  std::vector<Result> answers(Mode mode = Mode::contact) const;

  tools::Workload workload;
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

/// The number of results that differ in any bit.
size_t differences(std::span<const Result> a, std::span<const Result> b);

}  // namespace radar::test
