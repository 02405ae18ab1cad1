// Why a device is refused, over made-up devices.
#include <catch2/catch.hpp>

#include "gpu/requirements.h"
#include "radar/radar.h"

namespace {

radar::gpu::DeviceFacts goodDevice() {
  return {.apiVersion = VK_API_VERSION_1_3,
          .maxLayers = 2048,
          .subPixelBits = 8,
          .groupInvocations = 1024,
          .stageBuffers = 1024,
          .graphicsAndComputeQueue = true,
          .missingFeatures = {}};
}

}  // namespace

TEST_CASE("a device with everything is not refused") {
  CHECK(radar::gpu::reasonsAgainst(goodDevice()).empty());
}

TEST_CASE("each thing that a device lacks is a reason of its own, in words") {
  radar::gpu::DeviceFacts facts = goodDevice();
  facts.apiVersion = VK_API_VERSION_1_1;
  CHECK(radar::gpu::reasonsAgainst(facts) == std::vector<std::string>{"Vulkan 1.3 is needed, it has 1.1"});
  facts = goodDevice();
  facts.missingFeatures = {"maintenance4 (shaders are compiled for Vulkan 1.3)"};
  facts.graphicsAndComputeQueue = false;
  facts.maxLayers = 128;
  facts.subPixelBits = 2;
  facts.groupInvocations = 128;
  facts.stageBuffers = 4;
  const std::vector<std::string> reasons = radar::gpu::reasonsAgainst(facts);
  REQUIRE(reasons.size() == 6);
  CHECK(reasons[0].find("maintenance4") != std::string::npos);
  CHECK(reasons[1].find("queue family") != std::string::npos);
  CHECK(reasons[2].find("layers") != std::string::npos);
  CHECK(reasons[3].find("invocations") != std::string::npos);
  CHECK(reasons[4].find("storage buffers") != std::string::npos);
  CHECK(reasons[5].find("subpixel") != std::string::npos);
}

TEST_CASE("every required feature is switched on for a device that is opened") {
  radar::Requirements needed = radar::requirements(false);
  CHECK(needed.core.features.shaderFloat64 == VK_FALSE);
  CHECK(needed.vulkan12.shaderOutputLayer == VK_TRUE);
  CHECK(needed.vulkan12.scalarBlockLayout == VK_TRUE);
  CHECK(needed.vulkan13.synchronization2 == VK_TRUE);
  CHECK(needed.vulkan13.maintenance4 == VK_TRUE);
  CHECK(radar::requirements(true).core.features.shaderFloat64 == VK_TRUE);
}

TEST_CASE("the requirements chain in front of what a host asks for itself") {
  VkPhysicalDeviceRobustness2FeaturesEXT own{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ROBUSTNESS_2_FEATURES_EXT};
  radar::Requirements needed = radar::requirements(false);
  CHECK(needed.chain(&own) == &needed.core);
  CHECK(needed.core.pNext == &needed.vulkan12);
  CHECK(needed.vulkan12.pNext == &needed.vulkan13);
  CHECK(needed.vulkan13.pNext == &own);
}
