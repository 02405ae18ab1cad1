#include "gpu/pipeline.h"

#include "gpu/check.h"

namespace radar::gpu {

namespace {

ShaderModule shaderModule(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name) {
  const VkShaderModuleCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO, .codeSize = spirv.size_bytes(), .pCode = spirv.data()};
  VkShaderModule module;
  check(device.vk.CreateShaderModule(device.device(), &info, device.host.allocator, &module),
        std::string("vkCreateShaderModule ") + name);
  ShaderModule owned(device, module);
  device.setName(VK_OBJECT_TYPE_SHADER_MODULE, module, name);
  return owned;
}

VkPipelineShaderStageCreateInfo stageOf(VkShaderStageFlagBits stage, const ShaderModule& module) {
  return {.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
          .stage = stage,
          .module = module.get(),
          .pName = "main"};
}

}  // namespace

Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants, bool fullSubgroups) {
  const ShaderModule module = shaderModule(device, spirv, name);
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < constants.size(); ++i) entries.push_back({i, i * 4, sizeof(uint32_t)});
  const VkSpecializationInfo values{static_cast<uint32_t>(entries.size()), entries.data(), constants.size_bytes(),
                                    constants.data()};
  VkPipelineShaderStageCreateInfo stage = stageOf(VK_SHADER_STAGE_COMPUTE_BIT, module);
  if (!constants.empty()) stage.pSpecializationInfo = &values;
  const VkPipelineShaderStageRequiredSubgroupSizeCreateInfo size{
      .sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_REQUIRED_SUBGROUP_SIZE_CREATE_INFO,
      .requiredSubgroupSize = device.subgroupSize};
  if (fullSubgroups) stage.flags |= VK_PIPELINE_SHADER_STAGE_CREATE_REQUIRE_FULL_SUBGROUPS_BIT;
  if (fullSubgroups && device.choosesSubgroupSize) stage.pNext = &size;
  const VkComputePipelineCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO, .stage = stage, .layout = layout};
  VkPipeline pipeline;
  check(device.vk.CreateComputePipelines(device.device(), device.host.pipelineCache, 1, &info, device.host.allocator,
                                         &pipeline),
        std::string("vkCreateComputePipelines ") + name);
  Pipeline owned(device, pipeline);
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return owned;
}

Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, VkRenderPass renderPass,
                       std::span<const uint32_t> spirv, const char* name, uint32_t stride) {
  const ShaderModule module = shaderModule(device, spirv, name);
  const VkPipelineShaderStageCreateInfo stage = stageOf(VK_SHADER_STAGE_VERTEX_BIT, module);
  const VkVertexInputBindingDescription binding{0, stride, VK_VERTEX_INPUT_RATE_VERTEX};
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
                                          .renderPass = renderPass};
  VkPipeline pipeline;
  check(device.vk.CreateGraphicsPipelines(device.device(), device.host.pipelineCache, 1, &info, device.host.allocator,
                                          &pipeline),
        std::string("vkCreateGraphicsPipelines ") + name);
  Pipeline owned(device, pipeline);
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return owned;
}

}  // namespace radar::gpu
