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
};

std::string versionText(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." + std::to_string(VK_API_VERSION_MINOR(version));
}

}  // namespace

DeviceFacts factsOf(const Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vk.GetPhysicalDeviceProperties(device, &properties);
  DeviceFacts facts{
      .apiVersion = properties.apiVersion,
      .maxLayers = std::min(properties.limits.maxImageArrayLayers, properties.limits.maxFramebufferLayers),
      .subPixelBits = properties.limits.subPixelPrecisionBits,
      .groupInvocations = properties.limits.maxComputeWorkGroupInvocations,
      .stageBuffers = properties.limits.maxPerStageDescriptorStorageBuffers,
      .graphicsAndComputeQueue = queueFamilyOf(vk, device) != kNone,
      .doubles = false,
      .missingFeatures = {}};
  if (properties.apiVersion < VK_API_VERSION_1_3) return facts;  // the feature structs below do not exist there
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
  if (facts.stageBuffers < 16) {
    reasons.push_back("16 storage buffers in a stage are needed, it has " + std::to_string(facts.stageBuffers));
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
