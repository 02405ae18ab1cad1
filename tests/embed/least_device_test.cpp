// A device that has what mode contact needs and otherwise only the least that Vulkan 1.3 allows.
#include <cstring>

#include <vulkan/vulkan.h>
#include "embed/execute.h"
#include "embed/host.h"
#include "embed/host_world.h"
#include "fuzz/check_answers.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "radar/cpu_sweeper.h"
#include "radar/recorder.h"
#include "support/catch.h"
#include "support/same_bits.h"
#include "support/small_scenes.h"
#include "support/test_device.h"
#include "workloads/generate.h"
#include "workloads/hard_cases.h"

namespace {

using namespace radar;
using test::at;

VKAPI_ATTR void VKAPI_CALL leastProperties(VkPhysicalDevice device, VkPhysicalDeviceProperties* properties) {
  vkGetPhysicalDeviceProperties(device, properties);
  VkPhysicalDeviceLimits& limits = properties->limits;
  limits.maxComputeWorkGroupInvocations = limits.maxComputeWorkGroupSize[0] = 128;
  limits.maxComputeWorkGroupCount[0] = limits.maxComputeWorkGroupCount[1] = 65535;
  limits.maxPushConstantsSize = 128;
  limits.maxPerStageDescriptorStorageBuffers = 8;  // the only one that must be higher: Vulkan guarantees 4
  limits.maxPerStageDescriptorSampledImages = 16;
  limits.maxTexelBufferElements = 65536;
  limits.maxStorageBufferRange = 1u << 27;
  limits.maxImageArrayLayers = limits.maxFramebufferLayers = 256;
  limits.subPixelPrecisionBits = 4;
}

VKAPI_ATTR void VKAPI_CALL withoutOutputLayer(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
  vkGetPhysicalDeviceFeatures2(device, features);
  for (auto* next = static_cast<VkBaseOutStructure*>(features->pNext); next != nullptr; next = next->pNext) {
    if (next->sType != VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES) continue;
    reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(next)->shaderOutputLayer = VK_FALSE;
  }
}

VKAPI_ATTR void VKAPI_CALL leastFeatures(VkPhysicalDevice device, VkPhysicalDeviceFeatures2* features) {
  withoutOutputLayer(device, features);
  features->features.shaderFloat64 = VK_FALSE;
}

VKAPI_ATTR void VKAPI_CALL computeFamilies(VkPhysicalDevice device, uint32_t* count,
                                           VkQueueFamilyProperties* families) {
  vkGetPhysicalDeviceQueueFamilyProperties(device, count, families);
  if (families == nullptr) return;
  for (uint32_t i = 0; i < *count; ++i) families[i].queueFlags &= ~VkQueueFlags{VK_QUEUE_GRAPHICS_BIT};
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL leastLoader(VkInstance instance, const char* name) {
  const auto is = [&](const char* other) { return std::strcmp(name, other) == 0; };
  if (is("vkGetPhysicalDeviceProperties")) return reinterpret_cast<PFN_vkVoidFunction>(leastProperties);
  if (is("vkGetPhysicalDeviceFeatures2")) return reinterpret_cast<PFN_vkVoidFunction>(leastFeatures);
  if (is("vkGetPhysicalDeviceQueueFamilyProperties")) return reinterpret_cast<PFN_vkVoidFunction>(computeFamilies);
  return vkGetInstanceProcAddr(instance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL loaderWithoutOutputLayer(VkInstance instance, const char* name) {
  const bool hides = std::strcmp(name, "vkGetPhysicalDeviceFeatures2") == 0;
  return hides ? reinterpret_cast<PFN_vkVoidFunction>(withoutOutputLayer) : vkGetInstanceProcAddr(instance, name);
}

struct LeastDevice {
  LeastDevice() {
    const HostDevice offered = hostOf(host.handles.instance, host.handles.physicalDevice, leastLoader);
    CHECK_FALSE(offered.doubles);
    CHECK_FALSE(offered.sampled);
    host.handles.getInstanceProcAddr = offered.getInstanceProcAddr;
    host.handles.doubles = false;
  }
  test::Host host{Mode::contact};
};

/// Answers have the CPU's bits, but for the tier.
Answers checkCpus(Sweeper& sweeper, const Scene& scene, const std::vector<Query>& queries) {
  Answers found = sweeper.run(queries);
  fuzz::requireSame(found, CpuSweeper(scene).run(queries));
  return found;
}

}  // namespace

TEST_CASE("a device with the least limits, no doubles and no graphics gives the CPU's answers in mode contact") {
  LeastDevice least;
  CHECK(unsupportedReasons(least.host.handles, Mode::contact).empty());
  const Device device = Device::adopt(least.host.handles);
  CHECK(device.supports(Mode::contact));
  CHECK_FALSE(device.supports(Mode::sampled));
  CHECK_FALSE(device.doubles());
  // Some scenes have more triangles than such a device holds, and the CPU answers.
  size_t onDevice = 0;
  for (const tools::HardFamily& family : tools::hardFamilies()) {
    CAPTURE(family.name);
    const auto [scene, queries] = test::caseOf(tools::hardScene(family, 17, 0, 24, tools::Company::mixed));
    Sweeper sweeper(device, scene, {.cpuBatch = 0});
    onDevice += checkCpus(sweeper, scene, queries).stats.submissions > 0;
  }
  CHECK(onDevice >= 20);
}

TEST_CASE(
    "on a device with the least limits a host's moved objects and written queries, lists, clearances and steps get the "
    "CPU's answers") {
  LeastDevice least;
  const Device device = Device::adopt(least.host.handles);
  test::MovedWorld world(
      40, 27, {1, 10, 50}, [](ObjectId id) { return id % 4 != 0; }, [](ObjectId id) { return id % 8 == 1; }, device);
  Recorder recorder(
      device, world.scene,
      {.queries = 48, .candidates = 1u << 16, .rounds = 64, .unresolvedPairs = 1u << 14, .searches = 2000});
  Sweeper sweeper(device, world.scene, {.cpuBatch = 0});
  fuzz::Outcomes outcomes;
  const auto check = [&](const std::vector<Query>& queries, const Answers& found) {
    fuzz::checkRecorded(queries, found, CpuSweeper(world.truth).run(queries), outcomes);
  };
  for (int frame = 0; frame < 4; ++frame) {
    std::vector<Query> queries = world.queries(48);
    ask(recorder, test::Written(queries, device), world, outcomes);
    for (size_t i = 0; i < queries.size(); ++i) {
      if (queries[i].anyHit) continue;
      if (i % 4 == 0) queries[i].hits = i % 8 == 0 ? 3 : kAllHits;
      if (i % 4 == 1) queries[i].clearance = 0.25;
      if (i % 4 == 2) queries[i].ignoreLeaving = true;
      if (i % 4 == 3 && queries[i].distance < 1e20) tools::takeStep(queries[i]);
    }
    ask(recorder, queries, world, outcomes);
    world.tell();
    checkCpus(sweeper, world.truth, queries);
    check(queries, test::execute(device, recorder, queries));
    world.moveAgain();
  }
  CHECK(outcomes.lacking() + outcomes.outOfRange < outcomes.answered / 9);
  CHECK(outcomes.hits > outcomes.answered / 8);
  // Objects move during the step, too.
  for (ObjectId id = 0; id < 40; id += 3) {
    for (Scene* scene : {&world.scene, &world.truth}) scene->setMotion(id, {0.5, -1, 0.25});
  }
  world.tell();
  std::vector<Query> steps = world.queries(24);
  for (Query& query : steps) {
    if (query.distance < 1e20) tools::takeStep(query);
  }
  checkCpus(sweeper, world.truth, steps);
  std::erase_if(steps, [&](const Query& query) { return !test::isRecordable(query, world.scene); });
  check(steps, test::execute(device, recorder, steps));
}

TEST_CASE("a device without shaderOutputLayer gives the same answers and pictures in mode sampled") {
  test::Host host(Mode::contact);  // does not enable the feature, so that validation would report its use
  host.handles.sampled = true;
  host.handles.getInstanceProcAddr = loaderWithoutOutputLayer;
  CHECK(requirements(host.handles).vulkan12.shaderOutputLayer == VK_FALSE);
  const Device least = Device::adopt(host.handles);
  REQUIRE(least.supports(Mode::sampled));
  CHECK_FALSE(least.impl().choosesLayers);
  for (const tools::HardFamily& family : tools::hardFamilies()) {
    CAPTURE(family.name);
    test::Case one = test::caseOf(tools::hardScene(family, 17, 0, 12, tools::Company::mixed));
    std::erase_if(one.queries, [&](const Query& query) { return !validate(query, one.scene, Mode::sampled).empty(); });
    const auto& [scene, queries] = one;
    if (queries.empty()) continue;
    Sweeper sweeper(least, scene), expected(test::device(), scene);
    CHECK(test::differenceOf(sweeper.run(queries, Mode::sampled), expected.run(queries, Mode::sampled)) == "");
    const std::vector<float> found = sweeper.scopes(queries[0]).R, same = expected.scopes(queries[0]).R;
    REQUIRE(found.size() == same.size());
    CHECK(std::memcmp(found.data(), same.data(), found.size() * sizeof(float)) == 0);
  }
}

TEST_CASE("too many sensors for one submission are split, and a scene beyond the device's limits is left to the CPU") {
  LeastDevice least;
  const Device device = Device::adopt(least.host.handles);
  Scene scene;
  const MeshId mesh = test::addBox(scene);
  const auto addRow = [&](int count, double y) {
    for (int i = 0; i < count; ++i) scene.addObject({.mesh = mesh, .worldFromMesh = at(3 * i, y, 4)});
  };
  addRow(100, 0);
  // More sensors than a texel buffer of 65,536 elements holds.
  std::vector<Query> queries(5000, {.mesh = mesh, .direction = {0, 0, 1}, .distance = 10});
  for (int i = 0; i < 5000; ++i) queries[i].worldFromMesh = at(0.06 * i, 0.3, 0);
  Sweeper sweeper(device, scene, {.cpuBatch = 0});
  const Answers split = checkCpus(sweeper, scene, queries);
  CHECK(split.stats.submissions == 2);
  CHECK(split.stats.cpuQueries < queries.size());
  // More placements than such a texel buffer holds.
  addRow(6000, 40);
  sweeper.sync();
  CHECK(checkCpus(sweeper, scene, queries).stats.cpuQueries == queries.size());
  // Nor are lists of such a scene taken for empty, though their searches share submissions with others.
  queries.resize(40);
  for (size_t i = 0; i < queries.size(); i += 3) queries[i].hits = kAllHits;
  size_t listed = 0;
  for (const Listed& list : checkCpus(sweeper, scene, queries).lists) listed += list.hits.size();
  CHECK(listed > 5);
}

TEST_CASE("a list of excluded objects that exceeds the device's largest storage buffer excludes all of them") {
  LeastDevice least;
  const Device device = Device::adopt(least.host.handles);
  Scene scene;
  const MeshId mesh = test::addBox(scene);
  for (const double x : {50, 0}) scene.addObject({.mesh = mesh, .worldFromMesh = at(x, 0, 4)});
  // 2^27 bytes hold 2^25 ids, and object 1 comes behind them.
  Query query{.mesh = mesh, .direction = {0, 0, 1}, .distance = 10};
  query.exclude.assign(1u << 25, 0);
  query.exclude.push_back(1);
  Sweeper sweeper(device, scene, {.cpuBatch = 0});
  const Answers answers = sweeper.run({&query, 1});
  CHECK(answers.results[0].status == Status::clear);
  CHECK(answers.stats.cpuQueries == 1);
  Recorder recorder(device, scene);
  gpu::Submission submission(device.impl(), false);
  const gpu::Commands commands = submission.begin();
  CHECK_THROWS_WITH(recorder.record(commands, {&query, 1}),
                    test::StartsWith("the lists of excluded objects need a buffer of 134217732 bytes"));
}

TEST_CASE("record refuses deformed meshes if the scene's vertices exceed the device's largest storage buffer") {
  LeastDevice least;
  const Device device = Device::adopt(least.host.handles);
  // A vertex has 16 bytes, so 2^27 bytes hold 2^23 of them.
  constexpr uint32_t kVertices = (1u << 23) + 1;
  Scene scene;
  const std::vector<float> positions(size_t{3} * kVertices);
  const MeshId mesh = scene.addMesh(positions, test::triangle().indices, Bounds{{-1, -1, -1}, {1, 1, 1}});
  scene.addObject({.mesh = mesh});
  Recorder recorder(device, scene);
  gpu::Buffer host(device.impl(), "host's", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  host.reserve(12);
  const DeformedMesh deformed{mesh, {.buffer = host.get()}};
  gpu::Submission submission(device.impl(), false);
  const gpu::Commands commands = submission.begin();
  CHECK_THROWS_WITH(recorder.record(commands, std::span<const Query>(), {.meshes = {&deformed, 1}}),
                    test::StartsWith("the scene's vertices need a buffer of 134217744 bytes"));
}

TEST_CASE("a Sweeper refuses mode sampled and lists everything that the device lacks for it") {
  LeastDevice least;
  least.host.handles.sampled = true;
  const std::vector<std::string> reasons = unsupportedReasons(least.host.handles, Mode::sampled);
  REQUIRE(reasons.size() == 3);
  const Device device = Device::adopt(least.host.handles);
  Scene scene;
  const Query query{.mesh = test::addBox(scene), .direction = {0, 0, 1}, .distance = 1};
  Sweeper sweeper(device, scene);
  try {
    sweeper.run({&query, 1}, Mode::sampled);
    FAIL("run() did not throw");
  } catch (const Error& error) {
    CHECK_THAT(error.what(), test::StartsWith("run(): ") && test::Contains("does not support mode sampled"));
    CHECK(error.reasons == reasons);
  }
  CHECK_THROWS_WITH(sweeper.scopes(query),
                    test::StartsWith("scopes(): ") && test::Contains("does not support mode sampled"));
  least.host.handles.sampled = false;
  const Device unaware = Device::adopt(least.host.handles);
  CHECK_FALSE(unaware.supports(Mode::sampled));
}
