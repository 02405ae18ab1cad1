// Two devices, and queries for them.
#pragma once

#include "embed/host.h"
#include "radar/pool.h"
#include "support/watched_vulkan.h"
#include "workloads/generate.h"

namespace radar::test {

/// Sends queries of mode contact to the devices, however few they are.
inline constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

/// Made on first use.
struct TwoHosts {
  Host first{Mode::sampled, 0}, second{Mode::sampled, 1};
};
const TwoHosts& twoHosts();
/// Theirs, adopted on first use. Messages of the validation layers go to onValidation().
std::span<const Device> twoDevices();

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
