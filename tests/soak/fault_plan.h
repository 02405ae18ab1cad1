// A fault in something that answers.
#pragma once

#include <optional>
#include <string>

#include "faults/host_memory.h"
#include "fuzz/target.h"
#include "gpu/api.h"
#include "gpu/submission.h"
#include "radar/recorder.h"
#include "soak/tally.h"
#include "support/watched_vulkan.h"
#include "workloads/random.h"

namespace radar::soak {

/// Which call, or request for host memory, is to fail.
struct FaultPlan {
  std::optional<Fault> fault{};  ///< none: nothing
  int64_t number = 0;
  VkResult result = VK_SUCCESS;
  /// What an answer that is invalid must name.
  std::string reason() const { return fault == Fault::memory ? "" : gpu::resultName(result); }
};

/// Mostly none. `mayLose`: the device may be lost.
inline FaultPlan chooseFault(tools::Random& random, bool mayLose) {
  if (!random.oneIn(6)) return {};
  const int64_t number = random.below(1u << random.below(7));
  const VkResult shortage = random.oneIn(2) ? VK_ERROR_OUT_OF_DEVICE_MEMORY : VK_ERROR_OUT_OF_HOST_MEMORY;
  switch (random.below(mayLose ? 3 : 2)) {
    case 0:
      return {Fault::shortage, number, shortage};
    case 1:
      return {Fault::memory, 8 * number, VK_SUCCESS};
    default:
      return {Fault::lost, number % 4, VK_ERROR_DEVICE_LOST};
  }
}

/// Makes a call under a fault. `device`: if given, only its Vulkan calls fail.
template <class Call>
test::Attempt under(const FaultPlan& plan, Tally& tally, const Call& call, const HostDevice* device = nullptr) {
  test::Attempt outcome;
  if (!plan.fault) {
    call();
  } else if (*plan.fault == Fault::memory) {
    outcome = test::attemptWithoutMemory(plan.number, call);
  } else {
    const auto when = *plan.fault == Fault::lost ? test::VulkanFault::When::lost : test::VulkanFault::When::once;
    const test::VulkanFault fault(plan.number, plan.result, when, {.device = device});
    call();
    outcome.failed = fault.happened();
  }
  if (outcome.failed) tally.add(*plan.fault);
  return outcome;
}

/// Records under a fault in the engine's calls, or without a submission, and after these again; submits, and reads.
template <class Queries>
Answers record(Recorder& recorder, const Device& device, const Queries& queries, const HostGeometry& geometry,
               tools::Random& random, Tally& tally) {
  const FaultPlan plan = chooseFault(random, false);
  gpu::Submission submission(device.impl(), false);
  bool isRefused = false;
  const gpu::Commands commands = submission.begin();
  const test::Attempt outcome = under(plan, tally, [&] {
    try {
      recorder.record(commands, queries, geometry);
    } catch (const Error& error) {
      if (!plan.fault || error.vulkan != plan.result || plan.result == VK_SUCCESS) throw;
      isRefused = true;
    }
  });
  fuzz::require(isRefused <= outcome.failed, "a failure that was not made");
  const bool isLeft = !outcome.failed && random.oneIn(12);
  if (isLeft) tally.add(Fault::notSubmitted);
  if (isRefused || outcome.threw || isLeft) {
    recorder.reset();
    recorder.record(submission.begin(), queries, geometry);
  }
  submission.submitAndWait();
  return recorder.read();
}

}  // namespace radar::soak
