#include "support/bindings.h"

#include "gpu/api.h"

namespace radar::test {

Bindings::Bindings(const Device::Impl& device, uint32_t buffers, uint32_t pushBytes) : device_(&device) {
  std::vector<VkDescriptorSetLayoutBinding> slots;
  for (uint32_t number = 0; number < buffers; ++number) {
    slots.push_back({.binding = number,
                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                     .descriptorCount = 1,
                     .stageFlags = VK_SHADER_STAGE_COMPUTE_BIT});
  }
  const VkDescriptorSetLayoutCreateInfo setInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO, .bindingCount = buffers, .pBindings = slots.data()};
  setLayout_ = {device, setInfo};
  const VkDescriptorSetLayout setLayout = setLayout_.get();

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
  const VkPipelineLayoutCreateInfo layoutInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 1,
                                              .pSetLayouts = &setLayout,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &range};
  pipelineLayout_ = {device, layoutInfo};

  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, buffers};
  const VkDescriptorPoolCreateInfo poolInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size};
  pool_ = {device, poolInfo};
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool_.get(),
                                             .descriptorSetCount = 1,
                                             .pSetLayouts = &setLayout};
  gpu::check(device.vk.AllocateDescriptorSets(device.device(), &allocate, &set_), "vkAllocateDescriptorSets");
}

void Bindings::setBuffer(uint32_t number, VkBuffer buffer) {
  const VkDescriptorBufferInfo info{buffer, 0, VK_WHOLE_SIZE};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .dstBinding = number,
                                   .descriptorCount = 1,
                                   .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                   .pBufferInfo = &info};
  device_->vk.UpdateDescriptorSets(device_->device(), 1, &write, 0, nullptr);
}

void Bindings::bind(const gpu::Commands& commands) const {
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipelineLayout_.get(), 0, 1, &set_, 0,
                                  nullptr);
}

}  // namespace radar::test
