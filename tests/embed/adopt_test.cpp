// The engine on a host's device. The host owns instance, device and queue; the engine borrows them and destroys
// nothing.
#include <memory>
#include <mutex>
#include <thread>

#include <vulkan/vulkan.h>
#include "embed/execute.h"
#include "embed/host.h"
#include "support/catch.h"
#include "support/small_scenes.h"
#include "support/test_device.h"
#include "support/watched_vulkan.h"
#include "sweep/sweeper.h"

namespace {

using namespace radar;

constexpr Mode kModes[] = {Mode::sampled, Mode::contact};
// Sends queries to the device, however few they are.
constexpr SweeperOptions kOnDevice{.cpuBatch = 0};

// A box in front of another.
struct Boxes {
  Result sweep(const Device& device, Mode mode) const {
    return Sweeper(device, scene, kOnDevice).run({&query, 1}, mode).results[0];
  }
  Scene scene;
  Query query{.mesh = test::addBox(scene), .direction = {0, 0, 1}, .distance = 10};
  ObjectId object = scene.addObject({.mesh = query.mesh, .worldFromMesh = test::at(0.1, 0.2, 4)});
};

}  // namespace

TEST_CASE("an adopted device answers like an opened one, and the host can use it afterwards") {
  Boxes boxes;
  test::Host host;
  CHECK(unsupportedReasons(host.handles, Mode::sampled).empty());
  for (const Mode mode : kModes) {
    const Result expected = boxes.sweep(test::device(), mode);
    const Result result = boxes.sweep(Device::adopt(host.handles), mode);
    CHECK(result.status == Status::hit);
    CHECK(result.t == expected.t);
  }
  CHECK(vkDeviceWaitIdle(host.handles.device) == VK_SUCCESS);
}

TEST_CASE("the engine uses only the host's function loader, allocator and pipeline cache") {
  Boxes boxes;
  test::Host host;
  VkPipelineCache cache;
  const VkPipelineCacheCreateInfo cacheInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
  REQUIRE(vkCreatePipelineCache(host.handles.device, &cacheInfo, nullptr, &cache) == VK_SUCCESS);
  host.handles.allocator = test::countingAllocator();
  host.handles.pipelineCache = cache;
  const uint64_t before = test::callsOf("vkQueueSubmit2");
  const int64_t allocated = test::allocations().all;
  {
    const Device device = Device::adopt(host.handles);
    for (const Mode mode : kModes) CHECK(boxes.sweep(device, mode).status == Status::hit);
  }
  CHECK(test::callsOf("vkQueueSubmit2") >= before + std::size(kModes));
  CHECK(test::lastPipelineCache() == cache);
  CHECK(test::allocations().all > allocated);
  CHECK(test::allocations().live == 0);
  CHECK(test::isLookedUp("vkQueueSubmit2"));
  // The engine does not even look up functions that wait for the host's own work.
  for (const char* never : {"vkDeviceWaitIdle", "vkQueueWaitIdle"}) CHECK_FALSE(test::isLookedUp(never));
  vkDestroyPipelineCache(host.handles.device, cache, nullptr);
}

TEST_CASE("each label that begins in a command buffer ends there, and none begins unless the host asks for them") {
  Boxes boxes;
  test::Host host;
  const test::TrueLabels reached;
  const auto begun = [] { return test::callsOf("vkCmdBeginDebugUtilsLabelEXT"); };
  const auto ended = [] { return test::callsOf("vkCmdEndDebugUtilsLabelEXT"); };
  const auto work = [&] {
    const Device device = Device::adopt(host.handles);
    for (const Mode mode : kModes) CHECK(boxes.sweep(device, mode).status == Status::hit);
    Recorder recorder(device, boxes.scene);
    CHECK(test::execute(device, recorder, std::span(&boxes.query, 1)).results[0].status == Status::hit);
  };
  const uint64_t begunBefore = begun(), endedBefore = ended();
  work();
  CHECK(begun() > begunBefore + 10);
  CHECK(ended() - endedBefore == begun() - begunBefore);
  const uint64_t asked = begun();
  host.handles.debugNames = false;
  work();
  CHECK(begun() == asked);
}

TEST_CASE("a batch takes two dispatches and two barriers for each round of its search, and few beside them") {
  Boxes boxes;
  test::Host host;
  const Device device = Device::adopt(host.handles);
  for (const uint32_t rounds : {2u, 4u}) {
    Sweeper::Impl sweeper(device.impl(), boxes.scene, kOnDevice, std::make_shared<GpuScene>(device.impl()),
                          {.rounds = rounds}, false);
    const auto run = [&] {
      Flight flight({&boxes.query, 1}, false);
      sweeper.begin(flight, Mode::contact);
      sweeper.finish(flight);
      CHECK(flight.answers.results[0].status == Status::hit);
      CHECK(flight.answers.stats.submissions == 1);
    };
    run();  // which uploads the scene
    const auto dispatched = [] { return test::callsOf("vkCmdDispatch") + test::callsOf("vkCmdDispatchIndirect"); };
    const uint64_t dispatches = dispatched(), barriers = test::callsOf("vkCmdPipelineBarrier2");
    run();
    CHECK(dispatched() - dispatches == (device.doubles() ? 8 : 4) + 2 * rounds);
    CHECK(test::callsOf("vkCmdPipelineBarrier2") - barriers == (device.doubles() ? 11 : 7) + 2 * rounds);
  }
}

TEST_CASE("adopt throws and names a function that the host's loader lacks") {
  test::Host host;
  host.handles.getInstanceProcAddr = [](VkInstance instance, const char* name) -> PFN_vkVoidFunction {
    return std::string(name) == "vkGetDeviceProcAddr" ? nullptr : vkGetInstanceProcAddr(instance, name);
  };
  CHECK_THROWS_WITH(Device::adopt(host.handles), test::Contains("vkGetDeviceProcAddr is missing"));
}

TEST_CASE("adopt refuses what a host has filled in wrongly, and names it") {
  test::Host host;
  const auto refuses = [&](const auto& change, const char* why) {
    HostDevice wrong = host.handles;
    change(wrong);
    std::vector<std::string> reasons;
    try {
      Device::adopt(wrong);
    } catch (const Error& error) {
      reasons = error.reasons;
    }
    REQUIRE(reasons.size() == 1);
    CHECK_THAT(reasons[0], test::StartsWith(why));
  };
  refuses([](HostDevice& wrong) { wrong.instance = VK_NULL_HANDLE; }, "HostDevice::instance is null");
  refuses([](HostDevice& wrong) { wrong.physicalDevice = VK_NULL_HANDLE; }, "HostDevice::physicalDevice is null");
  refuses([](HostDevice& wrong) { wrong.device = VK_NULL_HANDLE; }, "HostDevice::device is null");
  refuses([](HostDevice& wrong) { wrong.queueFamily = 99; }, "HostDevice::queueFamily: family 99 does not exist");
  // An instance without the extension has no such function.
  refuses(
      [](HostDevice& wrong) {
        wrong.getInstanceProcAddr = [](VkInstance instance, const char* name) -> PFN_vkVoidFunction {
          return std::string(name).ends_with("EXT") ? nullptr : vkGetInstanceProcAddr(instance, name);
        };
      },
      "HostDevice::debugNames: the instance lacks VK_EXT_debug_utils");
  HostDevice missing = host.handles;
  missing.physicalDevice = VK_NULL_HANDLE;
  CHECK(unsupportedReasons(missing, Mode::sampled) == std::vector<std::string>{"HostDevice::physicalDevice is null"});
}

TEST_CASE("two engines on two threads share a host's queue under the host's lock") {
  test::Host host;
  std::mutex mutex;
  uint64_t locked = 0;
  host.handles.lockQueue = [&] {
    mutex.lock();
    ++locked;
  };
  host.handles.unlockQueue = [&] { mutex.unlock(); };
  const test::CallsInTurn inTurn;
  const uint64_t before = test::callsOf("vkQueueSubmit2");
  std::vector<std::jthread> threads;
  std::array<double, 2> t{};
  threads.reserve(t.size());
  for (double& answer : t) {
    threads.emplace_back([&] {
      Boxes boxes;
      const Device device = Device::adopt(host.handles);
      Sweeper sweeper(device, boxes.scene, kOnDevice);
      for (int i = 0; i < 20; ++i) answer = sweeper.run({&boxes.query, 1}).results[0].t;
    });
  }
  threads.clear();
  CHECK(t == std::array<double, 2>{3, 3});
  CHECK(locked >= 2 * 20);
  CHECK(locked == test::callsOf("vkQueueSubmit2") - before);
}

TEST_CASE("two sweepers on one device follow the same scene") {
  Boxes boxes;
  Sweeper first(test::device(), boxes.scene, kOnDevice), second(test::device(), boxes.scene, kOnDevice);
  for (const Mode mode : kModes) {
    for (const double z : {4, 6}) {
      boxes.scene.setTransform(boxes.object, test::at(0.1, 0.2, z));
      for (Sweeper* sweeper : {&first, &second}) {
        CHECK(sweeper->run({&boxes.query, 1}, mode).results[0].t == Approx(z - 1));
      }
    }
  }
}

TEST_CASE("hostOf() tells what a physical device offers, and requirements() what of that to enable") {
  const test::Host made;
  const HostDevice host = hostOf(made.handles.instance, made.handles.physicalDevice);
  CHECK(host.device == VK_NULL_HANDLE);
  CHECK(host.queue == VK_NULL_HANDLE);
  VkPhysicalDeviceFeatures has;
  vkGetPhysicalDeviceFeatures(host.physicalDevice, &has);
  CHECK(host.doubles == (has.shaderFloat64 == VK_TRUE));
  CHECK(host.sampled == unsupportedReasons(host, Mode::sampled).empty());
  uint32_t count = host.queueFamily + 1;
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(host.physicalDevice, &count, families.data());
  REQUIRE(count == families.size());
  CHECK((families.back().queueFlags & VK_QUEUE_COMPUTE_BIT) != 0);
  for (const bool wants : {false, true}) {
    HostDevice wanted = host;
    wanted.doubles = wanted.sampled = wants;
    const Requirements needed = requirements(wanted);
    CHECK(needed.core.features.shaderFloat64 == (wants ? VK_TRUE : VK_FALSE));
    CHECK(needed.vulkan12.shaderOutputLayer <= (wants ? VK_TRUE : VK_FALSE));
    CHECK(needed.vulkan12.scalarBlockLayout == VK_TRUE);
  }
  // Without a device of the host's choice it is the one that would be opened.
  VkPhysicalDeviceProperties best;
  vkGetPhysicalDeviceProperties(hostOf(made.handles.instance).physicalDevice, &best);
  CHECK(best.deviceName == Device::open().name());
}

TEST_CASE("hostOf() refuses no instance, and a device that lacks what mode contact needs, with reasons") {
  CHECK_THROWS_WITH(hostOf(VK_NULL_HANDLE), "hostOf: expected an instance, got null");
  const test::Host made;
  const PFN_vkGetInstanceProcAddr withoutQueues = [](VkInstance instance, const char* name) {
    const PFN_vkGetPhysicalDeviceQueueFamilyProperties none = [](VkPhysicalDevice, uint32_t* count,
                                                                 VkQueueFamilyProperties*) { *count = 0; };
    return std::string(name) == "vkGetPhysicalDeviceQueueFamilyProperties" ? reinterpret_cast<PFN_vkVoidFunction>(none)
                                                                           : vkGetInstanceProcAddr(instance, name);
  };
  for (const VkPhysicalDevice device : {made.handles.physicalDevice, VkPhysicalDevice{}}) {
    std::vector<std::string> reasons;
    try {
      hostOf(made.handles.instance, device, withoutQueues);
    } catch (const Error& error) {
      CHECK_THAT(error.what(), test::StartsWith("no usable Vulkan device"));
      reasons = error.reasons;
    }
    REQUIRE_FALSE(reasons.empty());
    CHECK_THAT(reasons[0], test::StartsWith("device 0, ") && test::Contains("queue"));
  }
}

TEST_CASE("a device that is opened has debug names if messages of validation are heard and names are wanted") {
  const auto named = [](const DeviceOptions& options) { return Device::open(options).impl().host.debugNames; };
  CHECK(named({.onValidation = test::onValidation}));
  CHECK_FALSE(named({.onValidation = test::onValidation, .debugNames = false}));
  CHECK_FALSE(named({}));
}

TEST_CASE("opening a device that does not exist throws and names its number") {
  CHECK_THROWS_WITH(Device::open({.index = 1000}), test::Contains("device 1000 does not exist"));
}

TEST_CASE("a host with an instance of Vulkan 1.0 is told that it needs one of Vulkan 1.3") {
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  HostDevice host{.getInstanceProcAddr = vkGetInstanceProcAddr};
  REQUIRE(vkCreateInstance(&info, nullptr, &host.instance) == VK_SUCCESS);
  uint32_t count = 1;
  vkEnumeratePhysicalDevices(host.instance, &count, &host.physicalDevice);
  const std::vector<std::string> reasons = unsupportedReasons(host, Mode::contact);
  REQUIRE(reasons.size() == 1);
  CHECK_THAT(reasons[0], test::StartsWith("needs an instance of Vulkan 1.3 (VkApplicationInfo::apiVersion)"));
  vkDestroyInstance(host.instance, nullptr);
}
