// Two devices, whose queues a test can hold, slow or break; and something to ask them.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>

#include "radar/pool.h"
#include "workloads/generate.h"

namespace radar::test {

/// What the calls of a device do. May be changed while it works.
class Faults {
 public:
  /// The `n`-th of these calls from now (0: the next) and all later ones answer `result`.
  void failFrom(std::string_view call, int n, VkResult result);
  void mend();
  /// Devices sleep after vkWaitForFences until release().
  void hold();
  void release();
  /// Sleeps until a device is held.
  void awaitHeld();
  VkResult answer(std::string_view call);

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::string call_;
  int left_ = 0;
  VkResult result_ = VK_SUCCESS;
  bool holding_ = false;
  int held_ = 0;
};

/// So that queries of mode contact go to the devices, too.
inline constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

/// Opened on first use, with the validation layers listening.
std::span<const Device> twoDevices();
/// Of those. A test that breaks something mends it.
Faults& faults(size_t device);

/// A scene of boxes and the queries of its sensors; every third is of mode sampled.
struct Boxes {
  explicit Boxes(uint32_t sensors, uint32_t boxes = 2'000);
  /// What a plain sweeper on the first device says.
  std::vector<Result> answers() const;

  tools::Workload workload;
  tools::ScenePlayer player;
  std::vector<Query> queries;
};

/// How many differ in some bit.
size_t differences(std::span<const Result> a, std::span<const Result> b);

}  // namespace radar::test
