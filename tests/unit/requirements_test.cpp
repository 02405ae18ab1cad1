// The reasons why made-up devices are unsupported.
#include "gpu/requirements.h"

#include <algorithm>
#include "radar/radar.h"
#include "spirv/radar_shaders.h"
#include "support/catch.h"

namespace {

using namespace radar;

constexpr gpu::SubgroupFacts kSubgroups{.size = 32, .canChoose = true, .isFixed = true, .ballots = true};

// The least limits that Vulkan 1.3 allows, except for storage buffers.
VkPhysicalDeviceLimits leastLimits() {
  VkPhysicalDeviceLimits limits{};
  limits.maxComputeWorkGroupInvocations = 128;
  limits.maxComputeWorkGroupSize[0] = 128;
  limits.maxComputeWorkGroupCount[0] = limits.maxComputeWorkGroupCount[1] = 65535;
  limits.maxPushConstantsSize = 128;
  limits.maxPerStageDescriptorStorageBuffers = 8;
  limits.maxPerStageDescriptorSampledImages = 16;
  limits.maxTexelBufferElements = 65536;
  limits.maxStorageBufferRange = 1u << 27;
  limits.maxImageArrayLayers = limits.maxFramebufferLayers = 256;
  limits.subPixelPrecisionBits = 4;
  return limits;
}

gpu::DeviceFacts goodDevice() {
  VkPhysicalDeviceLimits limits = leastLimits();
  limits.maxComputeWorkGroupInvocations = limits.maxComputeWorkGroupSize[0] = 1024;
  return {.apiVersion = VK_API_VERSION_1_3,
          .computeQueue = true,
          .graphicsAndComputeQueue = true,
          .subgroups = kSubgroups,
          .missingFeatures = {},
          .limits = gpu::limitsOf(limits, kSubgroups)};
}

// The largest number of descriptors of these types that a shader of the mode binds.
uint64_t mostOf(std::initializer_list<VkDescriptorType> types, Mode mode) {
  size_t most = 0, count = 0;
  for (const gpu::Shader* shader : shaders::kAll) {
    const bool isOfSampled = shader->use == gpu::Use::sampled;
    if (shader->stage != VK_SHADER_STAGE_COMPUTE_BIT || isOfSampled != (mode == Mode::sampled)) continue;
    ++count;
    size_t bound = 0;
    for (const gpu::Binding& binding : shader->bindings) bound += std::ranges::count(types, binding.type);
    most = std::max(most, bound);
  }
  REQUIRE(count > 2);
  return most;
}

uint64_t neededOf(const std::string& name, Mode mode) {
  for (const DeviceLimit& limit : goodDevice().limits) {
    if (limit.name == name && limit.mode == mode) return limit.needed;
  }
  return 0;
}

}  // namespace

TEST_CASE("a device with everything supports both modes") {
  CHECK(gpu::unsupportedReasons(goodDevice(), Mode::sampled).empty());
  CHECK(gpu::unsupportedReasons(goodDevice(), Mode::contact).empty());
}

TEST_CASE("each thing that a device lacks is a separate reason in words") {
  gpu::DeviceFacts facts = goodDevice();
  facts.apiVersion = VK_API_VERSION_1_1;
  CHECK(gpu::unsupportedReasons(facts, Mode::contact) == std::vector<std::string>{"needs Vulkan 1.3, has 1.1.0"});
  facts = goodDevice();
  facts.missingFeatures = {{"scalarBlockLayout (buffers have the layout of the C++ structs)"}};
  facts.computeQueue = facts.graphicsAndComputeQueue = false;
  facts.subgroups = {.size = 32};
  VkPhysicalDeviceLimits limits = leastLimits();
  limits.maxPerStageDescriptorStorageBuffers = 4;
  facts.limits = gpu::limitsOf(limits, kSubgroups);
  const std::vector<std::string> reasons = gpu::unsupportedReasons(facts, Mode::contact);
  REQUIRE(reasons.size() == 5);
  CHECK(reasons[0] == "lacks the feature scalarBlockLayout (buffers have the layout of the C++ structs)");
  CHECK(reasons[1].find("queue family") != std::string::npos);
  CHECK(reasons[2].find("votes and ballots") != std::string::npos);
  CHECK(reasons[3].find("subgroup size varies") != std::string::npos);
  CHECK(reasons[4] == "the limit maxPerStageDescriptorStorageBuffers is 4, must be at least 8");
}

TEST_CASE("a device without what only mode sampled needs supports mode contact") {
  gpu::DeviceFacts facts = goodDevice();
  facts.graphicsAndComputeQueue = false;
  VkPhysicalDeviceLimits limits = leastLimits();
  limits.maxImageArrayLayers = limits.maxFramebufferLayers = 1;
  limits.subPixelPrecisionBits = 0;
  facts.limits = gpu::limitsOf(limits, kSubgroups);
  CHECK(gpu::unsupportedReasons(facts, Mode::contact).empty());
  const std::vector<std::string> reasons = gpu::unsupportedReasons(facts, Mode::sampled);
  REQUIRE(reasons.size() == 6);
  CHECK(reasons[0] == "has no queue family that supports graphics and compute");
  CHECK(reasons[1] == "the limit maxComputeWorkGroupInvocations is 128, must be at least 256");
}

TEST_CASE("mode contact needs no more than the least limits of Vulkan 1.3, except for storage buffers") {
  for (const uint32_t lanes : {4u, 8u, 16u, 32u, 64u}) {
    gpu::DeviceFacts facts = goodDevice();
    facts.subgroups.size = lanes;
    facts.limits = gpu::limitsOf(leastLimits(), facts.subgroups);
    CHECK(gpu::unsupportedReasons(facts, Mode::contact).empty());
  }
}

TEST_CASE("a limit that equals the requirement suffices, and one less is a reason") {
  for (const Mode mode : {Mode::contact, Mode::sampled}) {
    gpu::DeviceFacts facts = goodDevice();
    for (size_t i = 0; i < facts.limits.size(); ++i) {
      if (facts.limits[i].mode != mode) continue;
      gpu::DeviceFacts changed = facts;
      changed.limits[i].has = changed.limits[i].needed;
      CHECK(gpu::unsupportedReasons(changed, mode).empty());
      --changed.limits[i].has;
      CHECK(gpu::unsupportedReasons(changed, mode).size() == 1);
    }
  }
}

TEST_CASE("the required descriptors per stage are the most that a shader binds, and no more") {
  constexpr VkDescriptorType kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                             kTexels = VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER,
                             kImage = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  CHECK(neededOf("maxPerStageDescriptorStorageBuffers", Mode::contact) == mostOf({kStorage}, Mode::contact));
  CHECK(neededOf("maxPerStageDescriptorSampledImages", Mode::contact) == mostOf({kTexels, kImage}, Mode::contact));
  // Mode sampled binds no more.
  CHECK(mostOf({kStorage}, Mode::sampled) <= mostOf({kStorage}, Mode::contact));
  CHECK(mostOf({kTexels, kImage}, Mode::sampled) <= mostOf({kTexels, kImage}, Mode::contact));
}

TEST_CASE("the requirements list the features of every device, and optional ones only on request") {
  for (const bool outputLayer : {false, true}) {
    const Requirements needed = gpu::requirements(false, outputLayer);
    CHECK(needed.core.features.shaderFloat64 == VK_FALSE);
    CHECK(needed.vulkan12.shaderOutputLayer == (outputLayer ? VK_TRUE : VK_FALSE));
    CHECK(needed.vulkan12.scalarBlockLayout == VK_TRUE);
    CHECK(needed.vulkan13.synchronization2 == VK_TRUE);
    CHECK(needed.vulkan13.maintenance4 == VK_TRUE);
    CHECK(needed.vulkan13.subgroupSizeControl == VK_TRUE);
    CHECK(needed.vulkan13.computeFullSubgroups == VK_TRUE);
    CHECK(gpu::requirements(true, outputLayer).core.features.shaderFloat64 == VK_TRUE);
  }
}

TEST_CASE("the requirements are chained in front of a host's own features") {
  VkPhysicalDeviceRobustness2FeaturesEXT own{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
  Requirements needed = gpu::requirements(false, false);
  CHECK(needed.chain(&own) == &needed.core);
  CHECK(needed.core.pNext == &needed.vulkan12);
  CHECK(needed.vulkan12.pNext == &needed.vulkan13);
  CHECK(needed.vulkan13.pNext == &own);
}

TEST_CASE("the requirements are set in the host's own structs, and the other features there stay as they are") {
  VkPhysicalDeviceVulkan13Features own13{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES,
                                         .dynamicRendering = VK_TRUE};
  VkPhysicalDeviceFeatures2 own{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &own13};
  own.features.samplerAnisotropy = VK_TRUE;
  Requirements needed = gpu::requirements(true, true);
  CHECK(needed.chain(&own) == &needed.vulkan12);
  CHECK(needed.vulkan12.pNext == &own);
  CHECK(own.pNext == &own13);
  CHECK(own.features.samplerAnisotropy == VK_TRUE);
  CHECK(own.features.shaderFloat64 == VK_TRUE);
  CHECK(own.features.shaderInt64 == VK_FALSE);
  CHECK(own13.dynamicRendering == VK_TRUE);
  CHECK(own13.synchronization2 == VK_TRUE);
  CHECK(own13.maintenance4 == VK_TRUE);
  CHECK(own13.privateData == VK_FALSE);
  VkPhysicalDeviceVulkan12Features own12{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES, .pNext = &own};
  CHECK(needed.chain(&own12) == &own12);
  CHECK(own12.scalarBlockLayout == VK_TRUE);
  CHECK(own12.shaderOutputLayer == VK_TRUE);
  CHECK(own12.subgroupBroadcastDynamicId == VK_FALSE);
}
