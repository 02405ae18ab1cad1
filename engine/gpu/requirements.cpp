#include "gpu/requirements.h"

#include <algorithm>
#include <span>

#include "gpu/kernel.h"
#include "shaders/contact/interop.h"
#include "shaders/embed/interop.h"
#include "shaders/sampled/interop.h"

namespace radar::gpu {

namespace {

struct Requirement {
  const char* name;
  const char* why;
  bool isOf13;  // see MissingFeature
  VkBool32& (*in)(Requirements&);
};

const Requirement kRequired[] = {
    {"scalarBlockLayout", "buffers have the layout of the C++ structs", false,
     [](Requirements& f) -> VkBool32& { return f.vulkan12.scalarBlockLayout; }},
    {"synchronization2", "barriers name exact stages", true,
     [](Requirements& f) -> VkBool32& { return f.vulkan13.synchronization2; }},
    {"maintenance4", "shaders are compiled for Vulkan 1.3", true,
     [](Requirements& f) -> VkBool32& { return f.vulkan13.maintenance4; }},
    {"subgroupSizeControl", "a workgroup of the search is one subgroup", true,
     [](Requirements& f) -> VkBool32& { return f.vulkan13.subgroupSizeControl; }},
    {"computeFullSubgroups", "a workgroup of the search is one subgroup", true,
     [](Requirements& f) -> VkBool32& { return f.vulkan13.computeFullSubgroups; }},
};

bool isNeeded(Mode what, Mode mode) {
  return what == Mode::contact || mode == Mode::sampled;
}

// The search is slower with larger subgroups, because lanes wait for each other.
constexpr uint32_t kLargeSubgroup = 64;

std::vector<VkQueueFamilyProperties> queueFamiliesOf(const Api& vk, VkPhysicalDevice device) {
  uint32_t count = 0;
  vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vk.GetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  return families;
}

}  // namespace

std::string versionText(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version)) + "." +
         std::to_string(VK_API_VERSION_PATCH(version));
}

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

std::vector<DeviceLimit> limitsOf(const VkPhysicalDeviceLimits& limits, const SubgroupFacts& subgroups) {
  const uint32_t group = std::max({kContactGroup, kGatherGroup, subgroups.size});
  const auto contact = [](const char* name, uint64_t needed, uint64_t has) {
    return DeviceLimit{name, needed, has, Mode::contact};
  };
  const auto sampled = [](const char* name, uint64_t needed, uint64_t has) {
    return DeviceLimit{name, needed, has, Mode::sampled};
  };
  return {contact("maxComputeWorkGroupInvocations", group, limits.maxComputeWorkGroupInvocations),
          contact("maxComputeWorkGroupSize[0]", group, limits.maxComputeWorkGroupSize[0]),
          contact("maxComputeWorkGroupCount[0]", 65535, limits.maxComputeWorkGroupCount[0]),
          contact("maxComputeWorkGroupCount[1]", 65535, limits.maxComputeWorkGroupCount[1]),
          contact("maxPushConstantsSize", kMostPushBytes, limits.maxPushConstantsSize),
          // The most of any shader: requirements_test counts them.
          contact("maxPerStageDescriptorStorageBuffers", 8, limits.maxPerStageDescriptorStorageBuffers),
          contact("maxPerStageDescriptorSampledImages", 6, limits.maxPerStageDescriptorSampledImages),
          contact("maxTexelBufferElements", 65536, limits.maxTexelBufferElements),
          contact("maxStorageBufferRange", 1u << 27, limits.maxStorageBufferRange),
          sampled("maxComputeWorkGroupInvocations", kCells, limits.maxComputeWorkGroupInvocations),
          sampled("maxComputeWorkGroupSize[0]", kCells, limits.maxComputeWorkGroupSize[0]),
          sampled("maxImageArrayLayers", 256, limits.maxImageArrayLayers),
          sampled("maxFramebufferLayers", 256, limits.maxFramebufferLayers),
          sampled("subPixelPrecisionBits", 4, limits.subPixelPrecisionBits)};
}

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vk.GetPhysicalDeviceProperties(device, &properties);
  const uint32_t family = queueFamilyOf(vk, device);
  DeviceFacts facts{.apiVersion = properties.apiVersion,
                    .computeQueue = family != kNone,
                    .graphicsAndComputeQueue = (queueFlagsOf(vk, device, family) & VK_QUEUE_GRAPHICS_BIT) != 0};
  if (properties.apiVersion < VK_API_VERSION_1_3) return facts;  // the structs below do not exist there
  facts.subgroups = subgroupFactsOf(vk, device);
  facts.limits = limitsOf(properties.limits, facts.subgroups);
  Requirements features;
  features.chain();
  vk.GetPhysicalDeviceFeatures2(device, &features.core);
  facts.doubles = features.core.features.shaderFloat64 == VK_TRUE;
  facts.outputLayer = features.vulkan12.shaderOutputLayer == VK_TRUE;
  for (const Requirement& required : kRequired) {
    if (required.in(features)) continue;
    facts.missingFeatures.push_back({std::string(required.name) + " (" + required.why + ")", required.isOf13});
  }
  return facts;
}

std::vector<std::string> unsupportedReasons(const DeviceFacts& facts, Mode mode) {
  std::vector<std::string> reasons;
  if (facts.apiVersion < VK_API_VERSION_1_3) {
    return {"needs Vulkan 1.3, has " + versionText(facts.apiVersion)};
  }
  for (const MissingFeature& feature : facts.missingFeatures) {
    if (!feature.isOf13) continue;
    return {"needs an instance of Vulkan 1.3 (VkApplicationInfo::apiVersion): here the device, of Vulkan " +
            versionText(facts.apiVersion) + ", lacks the feature " + feature.text};
  }
  for (const MissingFeature& feature : facts.missingFeatures) {
    reasons.push_back("lacks the feature " + feature.text);
  }
  if (!facts.computeQueue) reasons.push_back("has no queue family that supports compute");
  if (mode == Mode::sampled && !facts.graphicsAndComputeQueue) {
    reasons.push_back("has no queue family that supports graphics and compute");
  }
  if (!facts.subgroups.ballots) reasons.push_back("lacks subgroup votes and ballots in compute shaders");
  if (!facts.subgroups.isFixed) reasons.push_back("its subgroup size varies and cannot be chosen");
  for (const DeviceLimit& limit : facts.limits) {
    if (limit.has >= limit.needed || !isNeeded(limit.mode, mode)) continue;
    reasons.push_back("the limit " + limit.name + " is " + std::to_string(limit.has) + ", must be at least " +
                      std::to_string(limit.needed));
  }
  return reasons;
}

uint32_t queueFamilyOf(const Api& vk, VkPhysicalDevice device) {
  const std::vector<VkQueueFamilyProperties> families = queueFamiliesOf(vk, device);
  constexpr VkQueueFlags kBoth = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (const VkQueueFlags needed : {kBoth, VkQueueFlags{VK_QUEUE_COMPUTE_BIT}}) {
    for (uint32_t i = 0; i < families.size(); ++i) {
      if ((families[i].queueFlags & needed) == needed) return i;
    }
  }
  return kNone;
}

VkQueueFlags queueFlagsOf(const Api& vk, VkPhysicalDevice device, uint32_t family) {
  const std::vector<VkQueueFamilyProperties> families = queueFamiliesOf(vk, device);
  return family < families.size() ? families[family].queueFlags : 0;
}

}  // namespace radar::gpu

namespace radar {

namespace {

// The chain's struct of that type, or null.
template <class T>
T* findIn(void* chain, VkStructureType type) {
  for (auto* at = static_cast<VkBaseOutStructure*>(chain); at != nullptr; at = at->pNext) {
    if (at->sType == type) return reinterpret_cast<T*>(at);
  }
  return nullptr;
}

// Sets what is set in `from`, from its member `first` to its member `last`, which are all VkBool32.
template <class T>
void enable(T& to, const T& from, VkBool32 T::*first, VkBool32 T::*last) {
  VkBool32* out = &(to.*first);
  for (const VkBool32* in = &(from.*first); in <= &(from.*last); ++in, ++out) *out |= *in;
}

}  // namespace

const void* Requirements::chain(void* next) {
  auto* const own2 = findIn<VkPhysicalDeviceFeatures2>(next, core.sType);
  auto* const own12 = findIn<VkPhysicalDeviceVulkan12Features>(next, vulkan12.sType);
  auto* const own13 = findIn<VkPhysicalDeviceVulkan13Features>(next, vulkan13.sType);
  void* first = next;
  const auto prepend = [&](auto& features) {
    features.pNext = first;
    first = &features;
  };
  if (own13 == nullptr) {
    prepend(vulkan13);
  } else {
    using Features = VkPhysicalDeviceVulkan13Features;
    enable(*own13, vulkan13, &Features::robustImageAccess, &Features::maintenance4);
  }
  if (own12 == nullptr) {
    prepend(vulkan12);
  } else {
    using Features = VkPhysicalDeviceVulkan12Features;
    enable(*own12, vulkan12, &Features::samplerMirrorClampToEdge, &Features::subgroupBroadcastDynamicId);
  }
  if (own2 == nullptr) {
    prepend(core);
  } else {
    using Features = VkPhysicalDeviceFeatures;
    enable(own2->features, core.features, &Features::robustBufferAccess, &Features::inheritedQueries);
  }
  return first;
}

Requirements gpu::requirements(bool doubles, bool outputLayer) {
  Requirements needed;
  needed.core.features.shaderFloat64 = doubles ? VK_TRUE : VK_FALSE;
  needed.vulkan12.shaderOutputLayer = outputLayer ? VK_TRUE : VK_FALSE;
  for (const Requirement& required : kRequired) required.in(needed) = VK_TRUE;
  return needed;
}

}  // namespace radar
