// A device proves itself by known answers: one that computes wrongly, never ends or is lost is refused before it
// answers.
#include "sweep/known_answers.h"

#include <future>

#include "embed/known_recordings.h"
#include "gpu/device.h"
#include "radar/recorder.h"
#include "support/catch.h"
#include "support/test_device.h"

namespace {

using namespace radar;

void checkAll(const std::vector<AnswerCheck>& checks) {
  for (const AnswerCheck& check : checks) {
    CAPTURE(check.kind, check.firstWrong);
    CHECK(check.passed());
    CHECK(check.asked >= 10);
  }
}

VKAPI_ATTR VkResult VKAPI_CALL neverEnds(VkDevice, uint32_t, const VkFence*, VkBool32, uint64_t) {
  return VK_TIMEOUT;
}
PFN_vkWaitForFences waitForFences;
/// What is lost works no more; lavapipe, which plays it, would.
template <VkResult kResult>
VKAPI_ATTR VkResult VKAPI_CALL waitsAndSays(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all,
                                            uint64_t patience) {
  waitForFences(device, count, fences, all, patience);
  return kResult;
}
std::promise<void> endCompiling, compiled;
VKAPI_ATTR VkResult VKAPI_CALL compilesUntilTold(VkDevice, VkPipelineCache, uint32_t,
                                                 const VkComputePipelineCreateInfo*, const VkAllocationCallbacks*,
                                                 VkPipeline*) {
  endCompiling.get_future().wait();
  compiled.set_value();
  return VK_ERROR_UNKNOWN;
}
VKAPI_ATTR void VKAPI_CALL doesNothing(VkCommandBuffer, uint32_t, uint32_t, uint32_t) {}

Device ownDevice() {
  return Device::open({.onValidation = test::onValidation, .doubles = test::wantsDoubles()});
}

/// A call's error.
template <class Call>
Error errorOf(const Call& call) {
  try {
    call();
  } catch (const Error& error) {
    return error;
  }
  FAIL("nothing was thrown");
  return Error("");
}

}  // namespace

TEST_CASE("a device gives known answers of every kind, to the bit") {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    CAPTURE(seed);
    const std::vector<AnswerCheck> checks = checkAnswers(test::device(), seed);
    CHECK(checks.size() == 7);
    checkAll(checks);
  }
}

TEST_CASE("a device gives known answers in mode contact, whatever the number of its lanes", "[subgroups]") {
  for (uint64_t seed = 0; seed < 2; ++seed) {
    checkAll(checkSweeper(test::device().impl(), seed, true));
    checkAll(checkRecorder(test::device().impl(), seed));
  }
}

TEST_CASE("a device that answers wrongly is refused with the reasons, by Sweepers that search on it and by Recorders") {
  const Scene scene;
  const Device device = ownDevice();
  gpu::Api& vk = device.impl().vk;
  const PFN_vkCmdDispatch dispatch = vk.CmdDispatch;
  vk.CmdDispatch = doesNothing;
  const auto searches = [&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); };
  const Error error = errorOf(searches);
  CAPTURE(error.what(), error.reasons);
  CHECK_THAT(error.what(), test::Contains(device.name()) && test::Contains("wrong answers to known queries"));
  REQUIRE_FALSE(error.reasons.empty());
  CHECK_THAT(error.reasons[0], test::StartsWith("first contacts: ") && test::Contains(" answers are wrong; "));
  // What it has shown once, it need not show again.
  vk.CmdDispatch = dispatch;
  CHECK_THROWS_AS(searches(), Error);
  CHECK_THROWS_WITH(Recorder(device, scene), test::Contains("wrong answers to known queries"));
  // Where nothing is searched on it, it is no matter.
  const Sweeper onCpu(device, scene, {.cpuBatch = kNone});
}

TEST_CASE("a device that reads a host's geometry wrongly is refused by Recorders") {
  const Scene scene;
  const Device device = ownDevice();
  const Sweeper sweeper(device, scene, {.cpuBatch = 0});
  device.impl().vk.CmdDispatch = doesNothing;
  const Error error = errorOf([&] { const Recorder recorder(device, scene); });
  REQUIRE_FALSE(error.reasons.empty());
  CHECK_THAT(error.reasons[0], test::StartsWith("recordings of a host's geometry: "));
}

TEST_CASE("a device that never ends is given up, and nothing of it is destroyed") {
  const Scene scene;
  const Device device = ownDevice();
  device.impl().vk.WaitForFences = neverEnds;
  const Error error = errorOf([&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); });
  CHECK_THAT(error.what(), test::Contains("has not ended a submission"));
  CHECK(error.vulkan == VK_ERROR_DEVICE_LOST);
}

TEST_CASE("a device that compiles for longer than its host waits is given up") {
  const Scene scene;
  std::string shader;
  uint32_t waited = 0;
  const Device device = Device::open({.onValidation = test::onValidation,
                                      .doubles = test::wantsDoubles(),
                                      .onCompiling = [&](const std::string& name, uint32_t seconds) {
                                        shader = name;
                                        waited = seconds;
                                        return seconds < 2;
                                      }});
  device.impl().vk.CreateComputePipelines = compilesUntilTold;
  const Error error = errorOf([&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); });
  CHECK_THAT(error.what(), test::Contains(" has not compiled " + shader + " in 2 s, and is given up"));
  CHECK(error.vulkan == VK_ERROR_DEVICE_LOST);
  CHECK(waited == 2);
  endCompiling.set_value();
  compiled.get_future().wait();
}

TEST_CASE("a device that is lost while it proves itself is refused") {
  const Scene scene;
  const Device device = ownDevice();
  waitForFences = device.impl().vk.WaitForFences;
  device.impl().vk.WaitForFences = waitsAndSays<VK_ERROR_DEVICE_LOST>;
  const Error error = errorOf([&] { const Recorder recorder(device, scene); });
  CHECK(error.vulkan == VK_ERROR_DEVICE_LOST);
}

TEST_CASE("a device whose answers lead to an error is refused with it") {
  const Scene scene;
  const Device device = ownDevice();
  waitForFences = device.impl().vk.WaitForFences;
  device.impl().vk.WaitForFences = waitsAndSays<VK_ERROR_UNKNOWN>;
  const Error error = errorOf([&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); });
  CHECK_THAT(error.what(), test::Contains("wrong answers to known queries"));
  REQUIRE_FALSE(error.reasons.empty());
  CHECK_THAT(error.reasons[0], test::StartsWith("first contacts: 24 of 24 answers are wrong; vkWaitForFences"));
}
