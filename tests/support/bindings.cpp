#include "support/bindings.h"

#include "gpu/check.h"

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
  VkDescriptorSetLayout setLayout;
  gpu::check(device.vk.CreateDescriptorSetLayout(device.device(), &setInfo, device.host.allocator, &setLayout),
             "vkCreateDescriptorSetLayout");
  setLayout_ = {device, setLayout};

  const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, pushBytes};
  const VkPipelineLayoutCreateInfo layoutInfo{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                              .setLayoutCount = 1,
                                              .pSetLayouts = &setLayout,
                                              .pushConstantRangeCount = 1,
                                              .pPushConstantRanges = &range};
  VkPipelineLayout layout;
  gpu::check(device.vk.CreatePipelineLayout(device.device(), &layoutInfo, device.host.allocator, &layout),
             "vkCreatePipelineLayout");
  pipelineLayout_ = {device, layout};

  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, buffers};
  const VkDescriptorPoolCreateInfo poolInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size};
  VkDescriptorPool pool;
  gpu::check(device.vk.CreateDescriptorPool(device.device(), &poolInfo, device.host.allocator, &pool),
             "vkCreateDescriptorPool");
  pool_ = {device, pool};
  const VkDescriptorSetAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                             .descriptorPool = pool,
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
