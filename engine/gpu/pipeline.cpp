#include "gpu/pipeline.h"

#include <algorithm>
#include <map>

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

Bindings::Bindings(const Device::Impl& device, std::span<const Binding> bindings, uint32_t pushBytes)
    : device_(&device) {
  std::vector<VkDescriptorSetLayoutBinding> slots;
  std::map<VkDescriptorType, uint32_t> counts;
  for (const Binding& binding : bindings) {
    const bool image = binding.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    slots.push_back({.binding = binding.number,
                     .descriptorType = binding.type,
                     .descriptorCount = 1,
                     .stageFlags = image ? VkShaderStageFlags{VK_SHADER_STAGE_COMPUTE_BIT}
                                         : VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT});
    ++counts[binding.type];
  }
  const VkDescriptorSetLayoutCreateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                .bindingCount = static_cast<uint32_t>(slots.size()),
                                                .pBindings = slots.data()};
  VkDescriptorSetLayout setLayout;
  check(device.vk.CreateDescriptorSetLayout(device.device(), &setInfo, device.host.allocator, &setLayout),
        "vkCreateDescriptorSetLayout");
  setLayout_ = {device, setLayout};

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
  const VkPipelineLayoutCreateInfo layoutInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 1,
                                              .pSetLayouts = &setLayout,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &range};
  VkPipelineLayout layout;
  check(device.vk.CreatePipelineLayout(device.device(), &layoutInfo, device.host.allocator, &layout),
        "vkCreatePipelineLayout");
  pipelineLayout_ = {device, layout};

  std::vector<VkDescriptorPoolSize> sizes;
  sizes.reserve(counts.size());
  for (const auto& [type, count] : counts) sizes.push_back({type, count});
  const VkDescriptorPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                            .maxSets = 1,
                                            .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                            .pPoolSizes = sizes.data()};
  VkDescriptorPool pool;
  check(device.vk.CreateDescriptorPool(device.device(), &poolInfo, device.host.allocator, &pool),
        "vkCreateDescriptorPool");
  pool_ = {device, pool};
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool,
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &setLayout};
  check(device.vk.AllocateDescriptorSets(device.device(), &allocate, &set_), "vkAllocateDescriptorSets");
}

void Bindings::setBuffer(uint32_t number, const Buffer& buffer) {
  if (buffer.capacity() == 0) return;
  const VkDeviceSize range =
      std::min<VkDeviceSize>(buffer.capacity(), device_->properties.limits.maxStorageBufferRange);
  const VkDescriptorBufferInfo info{buffer.get(), 0, range};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .dstBinding = number,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                   .pBufferInfo = &info};
  device_->vk.UpdateDescriptorSets(device_->device(), 1, &write, 0, nullptr);
}

void Bindings::setImage(uint32_t number, VkImageView view, VkSampler sampler) {
  const VkDescriptorImageInfo info{sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .dstBinding = number,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                                   .pImageInfo = &info};
  device_->vk.UpdateDescriptorSets(device_->device(), 1, &write, 0, nullptr);
}

void Bindings::bind(const Commands& commands) const {
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelineLayout_.get(), 0, 1, &set_, 0,
                                  nullptr);
}

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
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return {device, pipeline};
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
  device.setName(VK_OBJECT_TYPE_PIPELINE, pipeline, name);
  return {device, pipeline};
}

}  // namespace radar::gpu
