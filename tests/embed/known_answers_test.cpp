// A device proves itself by known answers: one that computes wrongly, never ends or is lost is refused before it
// answers.
#include "proof/checks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <future>

#include "proof/known_scene.h"
#include "radar/cpu_sweeper.h"
#include "radar/recorder.h"
#include "support/catch.h"
#include "support/separate_allocations.h"
#include "support/test_device.h"

namespace {

using namespace radar;

constexpr const char* kDiffers = "its answers to known queries differ from the CPU's";

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
/// What is lost works no more; the device that plays it would.
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
  return Device::open(test::deviceOptions());
}

/// A device whose memory begins with zeros: what no shader writes is the same everywhere.
Device clearedDevice() {
  HostDevice host = test::device().handles();
  host.memory = test::separateAllocations(host);
  host.memory.allocate = [give = host.memory.allocate](const MemoryRequest& request, MemoryPiece& piece) {
    MemoryRequest mapped = request;
    mapped.required |= VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    const VkResult result = give(mapped, piece);
    if (result == VK_SUCCESS) std::memset(piece.mapped, 0, request.requirements.size);
    return result;
  };
  return Device::adopt(host);
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
    checkAll(checkSweeper(test::device().impl(), seed));
    checkAll({checkClearances(test::device().impl(), seed)});
    checkAll(checkRecorder(test::device().impl(), seed));
  }
}

TEST_CASE(
    "a device that answers otherwise is refused with the reasons, by Sweepers that search on it and by Recorders") {
  const Scene scene;
  const Device device = clearedDevice();
  gpu::Api& vk = device.impl().vk;
  const PFN_vkCmdDispatch dispatch = vk.CmdDispatch;
  vk.CmdDispatch = doesNothing;
  const auto searches = [&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); };
  const Error error = errorOf(searches);
  CAPTURE(error.what(), error.reasons);
  CHECK_THAT(error.what(), test::Contains(device.name()) && test::EndsWith(kDiffers));
  CHECK(error.kind == Error::Kind::device);
  REQUIRE_FALSE(error.reasons.empty());
  CHECK_THAT(error.reasons[0],
             test::StartsWith("first contacts: ") &&
                 test::Contains(" answers differ from the CPU's, in searching or solving; answer 0: "));
  // What it has shown once, it need not show again.
  vk.CmdDispatch = dispatch;
  CHECK_THROWS_AS(searches(), Error);
  CHECK_THROWS_WITH(Recorder(device, scene), test::EndsWith(kDiffers));
  // Where nothing is searched on it, it is no matter.
  const Sweeper onCpu(device, scene, {.cpuBatch = kNone});
}

TEST_CASE("who is refused reads at which stage answers differ, in which numbers, bits and ulps") {
  const KnownScene known(0);
  const std::vector<Result> exact = CpuSweeper(known.scene).run(known.queries).results;
  const auto hit = std::find_if(exact.begin(), exact.end(), [](const Result& result) {
    return result.status == Status::hit && result.t > 0.125 && std::isfinite(result.normal[2]);
  });
  REQUIRE(hit != exact.end());
  std::vector<Result> answers(2, *hit);
  answers[0].t = 1;
  answers[0].normal = {0, 0, 1};
  std::vector<Result> found = answers;
  found[1].tier = Tier::sampled;  // who has answered is no matter
  CHECK(compared("lists", found, answers).passed());
  const auto reasonOf = [&](bool places = false) {
    const AnswerCheck check = compared("lists", found, answers, places);
    const Error error = errorOf([&] { requirePassed(test::device().impl(), {&check, 1}); });
    REQUIRE(error.reasons.size() == 1);
    return error.reasons[0];
  };
  found[0].t = 1 - 0x1p-53;
  found[0].normal[2] = 1 + 0x1p-51;
  CHECK(reasonOf() ==
        "lists: 1 of 2 answers differ from the CPU's, in describing; answer 0: t 0.99999999999999989, expected 1 "
        "(bits 0x1fffffffffffff, 1 ulp); normal z 1.0000000000000004, expected 1 (bits 0x2, 2 ulp)");
  CHECK_THAT(reasonOf(true), test::Contains(", in placing or describing; "));
  // The first stage of any answer counts, since others follow from it; the words are of the first answer.
  found[1].featureA = Feature::none;
  CHECK_THAT(reasonOf(), test::StartsWith("lists: 2 of 2 answers differ from the CPU's, in solving; answer 0: t "));
  found[1].status = Status::clear;
  found[0] = answers[0];
  found[1].object = kNone;
  CHECK_THAT(reasonOf(), test::StartsWith("lists: 1 of 2 answers differ from the CPU's, in searching or solving; "
                                          "answer 1: status clear, expected hit; object none, expected "));
  CHECK_THAT(reasonOf(true), test::Contains(", in placing, searching or solving; "));
  found[1] = answers[1];
  found[1].t = NAN;
  found[1].lo = -0.0;
  answers[1].lo = 0;
  CHECK_THAT(reasonOf(), test::Contains("; lo -0, expected 0 (bits 0x8000000000000000, 0 ulp)") &&
                             test::Contains("answer 1: t nan, expected ") && !test::Contains("t nan, expected 0 "));
}

TEST_CASE("a device that reads a host's geometry wrongly is refused by Recorders") {
  const Scene scene;
  const Device device = clearedDevice();
  const Sweeper sweeper(device, scene, {.cpuBatch = 0});
  device.impl().vk.CmdDispatch = doesNothing;
  const Error error = errorOf([&] { const Recorder recorder(device, scene); });
  REQUIRE_FALSE(error.reasons.empty());
  CHECK_THAT(error.reasons[0], test::StartsWith("recordings of a host's geometry: ") &&
                                   test::Contains(", in placing, searching or solving; "));
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
  DeviceOptions options = test::deviceOptions();
  options.onCompiling = [&](const std::string& name, uint32_t seconds) {
    shader = name;
    waited = seconds;
    return seconds < 2;
  };
  const Device device = Device::open(options);
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

TEST_CASE("answers that lead to an internal error are wrong, but a driver's failure is no answer") {
  const auto check = [](const Error& error) {
    return orAllWrong("lists", 24, [&]() -> AnswerCheck { throw Error(error); });
  };
  const AnswerCheck lost = check(Error(Error::Kind::internal, "lost a contact"));
  CHECK((lost.asked == 24 && lost.wrong == 24));
  CHECK(lost.firstWrong == "lost a contact");
  CHECK_THROWS_WITH(check(Error("a call", VK_ERROR_UNKNOWN)), "a call");
  CHECK_THROWS_WITH(check(Error("a value")), "a value");
  const Scene scene;
  const Device device = ownDevice();
  waitForFences = device.impl().vk.WaitForFences;
  device.impl().vk.WaitForFences = waitsAndSays<VK_ERROR_UNKNOWN>;
  const Error error = errorOf([&] { const Sweeper sweeper(device, scene, {.cpuBatch = 0}); });
  CHECK_THAT(error.what(), test::StartsWith("vkWaitForFences"));
  CHECK((error.vulkan == VK_ERROR_UNKNOWN && error.kind == Error::Kind::device));
}

TEST_CASE("an error tells the caller's mistakes from those of devices") {
  CHECK(errorOf([] { Scene().removeMesh(0); }).kind == Error::Kind::call);
  CHECK(errorOf([] { Device::open({.index = 1000}); }).kind == Error::Kind::call);
}
