// Why a device is refused, over made-up devices.
#include <catch2/catch.hpp>

#include "engine_shaders.h"
#include "gpu/requirements.h"
#include "gpu/spirv.h"
#include "radar/radar.h"

namespace {

radar::gpu::DeviceFacts goodDevice() {
  return {.apiVersion = VK_API_VERSION_1_3,
          .maxLayers = 2048,
          .subPixelBits = 8,
          .groupInvocations = 1024,
          .stageBuffers = 1024,
          .sharedBytes = 32768,
          .subgroups = {.size = 32, .canChoose = true, .isFixed = true, .ballots = true},
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
  facts.sharedBytes = 4096;
  facts.subgroups = {.size = 32};
  const std::vector<std::string> reasons = radar::gpu::reasonsAgainst(facts);
  REQUIRE(reasons.size() == 9);
  CHECK(reasons[0].find("maintenance4") != std::string::npos);
  CHECK(reasons[1].find("queue family") != std::string::npos);
  CHECK(reasons[2].find("layers") != std::string::npos);
  CHECK(reasons[3].find("invocations") != std::string::npos);
  CHECK(reasons[4].find("storage buffers") != std::string::npos);
  CHECK(reasons[5].find("votes and ballots") != std::string::npos);
  CHECK(reasons[6].find("size of its subgroups varies") != std::string::npos);
  CHECK(reasons[7].find("shared memory") != std::string::npos);
  CHECK(reasons[8].find("subpixel") != std::string::npos);
}

TEST_CASE("a device whose limits are just enough is not refused, and one step less is") {
  radar::gpu::DeviceFacts facts = goodDevice();
  facts.maxLayers = facts.groupInvocations = 256;
  facts.subPixelBits = 4;
  facts.sharedBytes = radar::gpu::searchSharedBytes(facts.subgroups.size);
  CHECK(radar::gpu::reasonsAgainst(facts).empty());
  --facts.sharedBytes;
  CHECK(radar::gpu::reasonsAgainst(facts).size() == 1);
}

TEST_CASE("as many storage buffers in a stage are required as the most that a shader binds, and no more") {
  size_t most = 0;
  for (const auto& [shader, spirv] : radar::test::kEngineShaders) {
    if (std::string(shader).ends_with(".vert")) continue;
    size_t count = 0;
    for (const radar::gpu::Descriptor& descriptor : radar::gpu::reflectCompute(spirv, shader).descriptors) {
      count += descriptor.type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    }
    most = std::max(most, count);
  }
  radar::gpu::DeviceFacts facts = goodDevice();
  facts.stageBuffers = static_cast<uint32_t>(most);
  CHECK(radar::gpu::reasonsAgainst(facts).empty());
  --facts.stageBuffers;
  CHECK(radar::gpu::reasonsAgainst(facts) ==
        std::vector<std::string>{std::to_string(most) + " storage buffers in a stage are needed, it has " +
                                 std::to_string(most - 1)});
}

TEST_CASE("the search fits the shared memory that every device has, up to subgroups of 64") {
  constexpr uint32_t kEveryDevice = 16384;  // the least maxComputeSharedMemorySize
  for (const uint32_t lanes : {4u, 8u, 16u, 32u, 64u}) CHECK(radar::gpu::searchSharedBytes(lanes) <= kEveryDevice);
  CHECK(radar::gpu::searchSharedBytes(32, 256) > radar::gpu::searchSharedBytes(32));
}

TEST_CASE("every required feature is switched on for a device that is opened") {
  radar::Requirements needed = radar::requirements(false);
  CHECK(needed.core.features.shaderFloat64 == VK_FALSE);
  CHECK(needed.vulkan12.shaderOutputLayer == VK_TRUE);
  CHECK(needed.vulkan12.scalarBlockLayout == VK_TRUE);
  CHECK(needed.vulkan13.synchronization2 == VK_TRUE);
  CHECK(needed.vulkan13.maintenance4 == VK_TRUE);
  CHECK(needed.vulkan13.subgroupSizeControl == VK_TRUE);
  CHECK(needed.vulkan13.computeFullSubgroups == VK_TRUE);
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
