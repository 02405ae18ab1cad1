// Makes pipelines.
#include <chrono>
#include <cstring>
#include <future>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "gpu/api.h"
#include "gpu/kernel.h"
#include "shaders/shared/interop.h"

namespace radar::gpu {

namespace {

ShaderModule shaderModule(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name) {
  const VkShaderModuleCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  return {device, info, name};
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, const ShaderModule& module) {
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = stage,
          .module = module.get(),
          .pName = "main"};
}

VkPipelineCreateFlags flagsOf(const Device::Impl& device) {
  return device.capturesStatistics ? VK_PIPELINE_CREATE_CAPTURE_STATISTICS_BIT_KHR : 0;
}

// The module, declaring that lanes which part in a branch meet behind it, if all came to it together: glslang can do so
// only for all devices.
std::vector<uint32_t> withUniformControlFlow(std::span<const uint32_t> spirv) {
  constexpr uint32_t kHeader = 5, kExtension = 10, kEntryPoint = 15, kExecutionMode = 16, kCapability = 17;
  constexpr uint32_t kSubgroupUniformControlFlow = 4421;
  constexpr char kName[] = "SPV_KHR_subgroup_uniform_control_flow";
  constexpr uint32_t kNameWords = sizeof(kName) / 4 + 1;
  std::vector<uint32_t> all(spirv.begin(), spirv.begin() + kHeader);
  const auto opcodeAt = [&](size_t at) { return at < spirv.size() ? spirv[at] & 0xffff : 0; };
  for (size_t at = kHeader, next = 0; at < spirv.size(); at = next) {
    next = at + (spirv[at] >> 16);
    all.insert(all.end(), spirv.begin() + at, spirv.begin() + next);
    if (opcodeAt(at) == kCapability && opcodeAt(next) != kCapability) {
      all.push_back((kNameWords + 1) << 16 | kExtension);
      all.resize(all.size() + kNameWords);
      std::memcpy(&all[all.size() - kNameWords], kName, sizeof(kName));
    } else if (opcodeAt(at) == kEntryPoint) {
      all.insert(all.end(), {3u << 16 | kExecutionMode, spirv[at + 2], kSubgroupUniformControlFlow});
    }
  }
  return all;
}

// A call that makes a compute pipeline, with all that it reads, since a driver that is given up goes on reading.
struct Compilation {
  Compilation(const Device::Impl& device, VkPipelineLayout layout, const ShaderModule& module,
              std::span<const uint32_t> values, Subgroups subgroups);
  VkResult run() { return create(device, cache, 1, &info, allocator, &pipeline); }

  PFN_vkCreateComputePipelines create;
  VkDevice device;
  VkPipelineCache cache;
  const VkAllocationCallbacks* allocator;
  std::vector<uint32_t> constants;
  std::vector<VkSpecializationMapEntry> entries;
  VkSpecializationInfo specialization{};
  VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{};
  VkComputePipelineCreateInfo info{};
  VkPipeline pipeline = VK_NULL_HANDLE;
};

Compilation::Compilation(const Device::Impl& its, VkPipelineLayout layout, const ShaderModule& module,
                         std::span<const uint32_t> values, Subgroups subgroups)
    : create(its.vk.CreateComputePipelines),
      device(its.device()),
      cache(its.host.pipelineCache),
      allocator(its.host.allocator),
      constants(values.begin(), values.end()),
      size{.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO,
           .requiredSubgroupSize = its.subgroupSize} {
  for (uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, sizeof(uint32_t)});
  specialization = {static_cast<uint32_t>(entries.size()), entries.data(), constants.size() * sizeof(uint32_t),
                    constants.data()};
  VkPipelineShaderStageCreateInfo stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, module);
  if (!constants.empty()) stage.pSpecializationInfo = &specialization;
  if (subgroups == Subgroups::full) stage.flags |= VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
  if (subgroups == Subgroups::full && its.choosesSubgroupSize) stage.pNext = &size;
  info = {
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .flags = flagsOf(its), .stage = stage, .layout = layout};
}

// Runs it on a thread of its own, and asks the host each second whether to go on.
VkResult runWatched(const Device::Impl& device, const std::shared_ptr<Compilation>& compilation, const char* name) {
  std::packaged_task<VkResult()> task([compilation] { return compilation->run(); });
  std::future<VkResult> result = task.get_future();
  std::thread(std::move(task)).detach();
  for (uint32_t seconds = 1; result.wait_for(std::chrono::seconds(1)) != std::future_status::ready; ++seconds) {
    bool goesOn = false;
    try {
      goesOn = device.host.onCompiling(name, seconds);
    } catch (...) {
      result.wait();
      throw;
    }
    if (goesOn) continue;
    device.abandoned = true;
    throw Error(device.name + " has not compiled " + name + " in " + std::to_string(seconds) + " s, and is given up",
                VK_ERROR_DEVICE_LOST);
  }
  return result.get();
}

}  // namespace

Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants, Subgroups subgroups) {
  std::vector<uint32_t> declaring;
  if (subgroups == Subgroups::full && device.host.uniformControlFlow) {
    declaring = withUniformControlFlow(spirv);
    spirv = declaring;
  }
  const ShaderModule module = shaderModule(device, spirv, name);
  const auto compilation = std::make_shared<Compilation>(device, layout, module, constants, subgroups);
  check(device.host.onCompiling ? runWatched(device, compilation, name) : compilation->run(),
        "vkCreateComputePipelines", name);
  Pipeline owned(device, compilation->pipeline);
  device.setName(VK_OBJECT_TYPE_PIPELINE, compilation->pipeline, name);
  return owned;
}

Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                       const char* name) {
  const RenderPass renderPass = depthRenderPass(device);  // any that is compatible
  const ShaderModule module = shaderModule(device, spirv, name);
  const VkPipelineShaderStageCreateInfo stage = stageOf(VK_SHADER_STAGE_VERTEX_BIT, module);
  const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attribute{0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0};
  const VkPipelineVertexInputStateCreateInfo vertexInput{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO,
      .vertexBindingDescriptionCount = 1,
      .pVertexBindingDescriptions = &binding,
      .vertexAttributeDescriptionCount = 1,
      .pVertexAttributeDescriptions = &attribute};
  const VkPipelineInputAssemblyStateCreateInfo assembly{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO,
      .topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST};
  const VkPipelineViewportStateCreateInfo viewport{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO, .viewportCount = 1, .scissorCount = 1};
  const VkPipelineRasterizationStateCreateInfo raster{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO,
      .polygonMode = VK_POLYGON_MODE_FILL,
      .cullMode = VK_CULL_MODE_NONE,
      .lineWidth = 1.0f};
  const VkPipelineMultisampleStateCreateInfo samples{.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO,
                                                     .rasterizationSamples = VK_SAMPLE_COUNT_1_BIT};
  const VkPipelineDepthStencilStateCreateInfo depth{.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO,
                                                    .depthTestEnable = VK_TRUE,
                                                    .depthWriteEnable = VK_TRUE,
                                                    .depthCompareOp = VK_COMPARE_OP_LESS};
  const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  const VkPipelineDynamicStateCreateInfo dynamic{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO, .dynamicStateCount = 2, .pDynamicStates = states};
  const VkGraphicsPipelineCreateInfo info{.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO,
                                          .flags = flagsOf(device),
                                          .stageCount = 1,
                                          .pStages = &stage,
                                          .pVertexInputState = &vertexInput,
                                          .pInputAssemblyState = &assembly,
                                          .pViewportState = &viewport,
                                          .pRasterizationState = &raster,
                                          .pMultisampleState = &samples,
                                          .pDepthStencilState = &depth,
                                          .pDynamicState = &dynamic,
                                          .layout = layout,
                                          .renderPass = renderPass.get()};
  VkPipeline pipeline;
  check(device.vk.CreateGraphicsPipelines(device.device(), device.host.pipelineCache, 1, &info, device.host.allocator,
                                          &pipeline),
        "vkCreateGraphicsPipelines", name);
  Pipeline owned(device, pipeline);
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return owned;
}

}  // namespace radar::gpu
