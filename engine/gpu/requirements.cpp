#include "gpu/requirements.h"

#include <algorithm>

#include "gpu/device.h"

namespace radar::gpu {

namespace {

struct Requirement {
  const char* name;
  const char* why;
  VkBool32& (*in)(Requirements&);
};

// A sensor is a layer of an array image, chosen in the vertex stage; structs are shared in scalar layout.
const Requirement kRequired[] = {
    {"shaderOutputLayer", "each sensor is a layer, chosen in the vertex stage",
     [](Requirements& f) -> VkBool32& { return f.vulkan12.shaderOutputLayer; }},
    {"scalarBlockLayout", "buffers share the structs of C++",
     [](Requirements& f) -> VkBool32& { return f.vulkan12.scalarBlockLayout; }},
    {"synchronization2", "barriers name exact stages",
     [](Requirements& f) -> VkBool32& { return f.vulkan13.synchronization2; }},
    {"maintenance4", "shaders are compiled for Vulkan 1.3",
     [](Requirements& f) -> VkBool32& { return f.vulkan13.maintenance4; }},
    {"subgroupSizeControl", "a workgroup of the search is one subgroup",
     [](Requirements& f) -> VkBool32& { return f.vulkan13.subgroupSizeControl; }},
    {"computeFullSubgroups", "a workgroup of the search is one subgroup",
     [](Requirements& f) -> VkBool32& { return f.vulkan13.computeFullSubgroups; }},
};

// A search is dearer to a large subgroup, whose lanes wait for each other.
constexpr uint32_t kLargeSubgroup = 64;

std::string versionText(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version));
}

}  // namespace

SubgroupFacts subgroupFactsOf(const Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceVulkan13Properties sizes{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties own{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES,
                                         .pNext = &sizes};
  VkPhysicalDeviceProperties2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &own};
  vk.GetPhysicalDeviceProperties2(device, &chain);
  constexpr VkSubgroupFeatureFlags kNeeded = VK_SUBGROUP_FEATURE_VOTE_BIT | VK_SUBGROUP_FEATURE_BALLOT_BIT;
  SubgroupFacts facts;
  facts.canChoose = (sizes.requiredSubgroupSizeStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
  facts.size = facts.canChoose && own.subgroupSize > kLargeSubgroup ? sizes.minSubgroupSize : own.subgroupSize;
  facts.isFixed = facts.canChoose || sizes.minSubgroupSize == sizes.maxSubgroupSize;
  facts.ballots = (own.subgroupSupportedOperations & kNeeded) == kNeeded &&
                  (own.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;
  return facts;
}

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vk.GetPhysicalDeviceProperties(device, &properties);
  DeviceFacts facts{
      .apiVersion = properties.apiVersion,
      .maxLayers = std::min(properties.limits.maxImageArrayLayers, properties.limits.maxFramebufferLayers),
      .subPixelBits = properties.limits.subPixelPrecisionBits,
      .groupInvocations = properties.limits.maxComputeWorkGroupInvocations,
      .stageBuffers = properties.limits.maxPerStageDescriptorStorageBuffers,
      .sharedBytes = properties.limits.maxComputeSharedMemorySize,
      .subgroups = {},
      .graphicsAndComputeQueue = queueFamilyOf(vk, device) != kNone,
      .doubles = false,
      .missingFeatures = {}};
  if (properties.apiVersion < VK_API_VERSION_1_3) return facts;  // the structs below do not exist there
  facts.subgroups = subgroupFactsOf(vk, device);
  Requirements features;
  features.chain();
  vk.GetPhysicalDeviceFeatures2(device, &features.core);
  facts.doubles = features.core.features.shaderFloat64 == VK_TRUE;
  for (const Requirement& required : kRequired) {
    if (!required.in(features)) facts.missingFeatures.push_back(std::string(required.name) + " (" + required.why + ")");
  }
  return facts;
}

std::vector<std::string> reasonsAgainst(const DeviceFacts& facts) {
  std::vector<std::string> reasons;
  if (facts.apiVersion < VK_API_VERSION_1_3) {
    reasons.push_back("Vulkan 1.3 is needed, it has " + versionText(facts.apiVersion));
  }
  for (const std::string& feature : facts.missingFeatures) reasons.push_back("lacks the feature " + feature);
  if (!facts.graphicsAndComputeQueue) reasons.push_back("has no queue family that does graphics and compute");
  if (facts.maxLayers < 256) {
    reasons.push_back("256 layers are needed, it has " + std::to_string(facts.maxLayers));
  }
  if (facts.groupInvocations < 256) {
    reasons.push_back("256 invocations in a workgroup are needed, it has " + std::to_string(facts.groupInvocations));
  }
  if (facts.stageBuffers < 8) {
    reasons.push_back("8 storage buffers in a stage are needed, it has " + std::to_string(facts.stageBuffers));
  }
  if (!facts.subgroups.ballots) reasons.push_back("has no votes and ballots of subgroups in compute shaders");
  if (!facts.subgroups.isFixed) reasons.push_back("the size of its subgroups varies and cannot be chosen");
  if (const uint32_t bytes = searchSharedBytes(facts.subgroups.size); facts.sharedBytes < bytes) {
    reasons.push_back(std::to_string(bytes) + " bytes of shared memory are needed, it has " +
                      std::to_string(facts.sharedBytes));
  }
  if (facts.subPixelBits < 4) {
    reasons.push_back("4 bits of subpixel precision are needed, it has " + std::to_string(facts.subPixelBits));
  }
  return reasons;
}

}  // namespace radar::gpu

namespace radar {

const void* Requirements::chain(void* next) {
  core.pNext = &vulkan12;
  vulkan12.pNext = &vulkan13;
  vulkan13.pNext = next;
  return &core;
}

Requirements requirements(bool doubles) {
  Requirements needed;
  needed.core.features.shaderFloat64 = doubles ? VK_TRUE : VK_FALSE;
  for (const gpu::Requirement& required : gpu::kRequired) required.in(needed) = VK_TRUE;
  return needed;
}

}  // namespace radar
