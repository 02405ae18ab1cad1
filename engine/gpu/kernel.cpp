#include "gpu/kernel.h"

#include <algorithm>
#include <cassert>

#include "gpu/check.h"
#include "gpu/pipeline.h"

namespace radar::gpu {

namespace {

// Every device takes this many workgroups along each axis.
constexpr uint32_t kMaxGroupsPerAxis = 65535;

DescriptorSetLayout makeSetLayout(const Device::Impl& device, const std::vector<Descriptor>& descriptors,
                                  VkShaderStageFlagBits stage, const char* name) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  bindings.reserve(descriptors.size());
  for (const Descriptor& descriptor : descriptors) {
    bindings.push_back({.binding = descriptor.binding,
                        .descriptorType = descriptor.type,
                        .descriptorCount = 1,
                        .stageFlags = VkShaderStageFlags(stage)});
  }
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = static_cast<uint32_t>(bindings.size()),
                                             .pBindings = bindings.data()};
  VkDescriptorSetLayout layout;
  check(device.vk.CreateDescriptorSetLayout(device.device(), &info, device.host.allocator, &layout),
        std::string("vkCreateDescriptorSetLayout ") + name);
  DescriptorSetLayout owned(device, layout);
  device.setName(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout, name);
  return owned;
}

PipelineLayout makePipelineLayout(const Device::Impl& device, VkDescriptorSetLayout setLayout, uint32_t pushBytes,
                                  VkShaderStageFlagBits stage, const char* name) {
  const VkPushConstantRange range{VkShaderStageFlags(stage), 0, pushBytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &setLayout,
                                        .pushConstantRangeCount = pushBytes > 0 ? 1u : 0u,
                                        .pPushConstantRanges = &range};
  VkPipelineLayout layout;
  check(device.vk.CreatePipelineLayout(device.device(), &info, device.host.allocator, &layout),
        std::string("vkCreatePipelineLayout ") + name);
  PipelineLayout owned(device, layout);
  device.setName(VK_OBJECT_TYPE_PIPELINE_LAYOUT, layout, name);
  return owned;
}

// A pool for one set.
DescriptorPool makePool(const Device::Impl& device, const std::vector<Descriptor>& descriptors, const char* name) {
  std::vector<VkDescriptorPoolSize> sizes;
  sizes.reserve(descriptors.size());
  for (const Descriptor& descriptor : descriptors) sizes.push_back({descriptor.type, 1});
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = 1,
                                        .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  VkDescriptorPool pool;
  check(device.vk.CreateDescriptorPool(device.device(), &info, device.host.allocator, &pool),
        std::string("vkCreateDescriptorPool ") + name);
  DescriptorPool owned(device, pool);
  device.setName(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, name);
  return owned;
}

}  // namespace

Kernel::Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name,
               VkShaderStageFlagBits stage)
    : device_(&device), name_(name), stage_(stage), interface_(reflectShader(spirv, name, stage)) {
  if (interface_.descriptors.empty()) throw Error("kernel \"" + name_ + "\" has no descriptors");
  if (interface_.pushBytes > kMaxPushBytes) {
    throw Error("kernel \"" + name_ + "\" has push constants of " + std::to_string(interface_.pushBytes) +
                " bytes, but only " + std::to_string(kMaxPushBytes) + " are portable");
  }
  setLayout_ = makeSetLayout(device, interface_.descriptors, stage, name);
  layout_ = makePipelineLayout(device, setLayout_.get(), interface_.pushBytes, stage, name);
}

Kernel::Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name,
               std::span<const uint32_t> constants, Subgroups subgroups)
    : Kernel(device, spirv, name, VK_SHADER_STAGE_COMPUTE_BIT) {
  pipeline_ = computePipeline(device, layout_.get(), spirv, name, constants, subgroups == Subgroups::full);
}

Kernel::Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name, const DepthTarget& target)
    : Kernel(device, spirv, name, VK_SHADER_STAGE_VERTEX_BIT) {
  pipeline_ = depthPipeline(device, layout_.get(), target.renderPass, spirv, name, target.vertexStride);
}

std::string Kernel::describe(const Descriptor& descriptor) const {
  return "kernel \"" + name_ + "\", binding " + std::to_string(descriptor.binding) + " (" + descriptor.name + ")";
}

KernelArguments::KernelArguments(const Kernel& kernel)
    : kernel_(&kernel),
      pool_(makePool(*kernel.device_, kernel.interface_.descriptors, kernel.name_.c_str())),
      bound_(kernel.interface_.descriptors.size()) {
  const Device::Impl& device = *kernel.device_;
  const VkDescriptorSetLayout layout = kernel.setLayout_.get();
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = pool_.get(),
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  gpu::check(device.vk.AllocateDescriptorSets(device.device(), &info, &set_),
             "vkAllocateDescriptorSets " + kernel.name_);
  device.setName(VK_OBJECT_TYPE_DESCRIPTOR_SET, set_, kernel.name_.c_str());
}

void KernelArguments::check(const Descriptor& descriptor, const Argument& argument) const {
  const auto fail = [&](const std::string& what) { throw Error(kernel_->describe(descriptor) + " " + what); };
  const auto given = [&] { return std::string("\"") + argument.buffer_->name() + "\""; };
  const bool wantsImage = descriptor.type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
  if (wantsImage != (argument.buffer_ == nullptr)) fail(wantsImage ? "is an image, not a buffer" : "is not an image");
  if (wantsImage) return;
  if (descriptor.type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER) {
    if (argument.texels_ == VK_NULL_HANDLE) fail("reads texels, but " + given() + " is not a TexelArray");
    return;
  }
  const bool isArray = descriptor.stride != 0;
  const uint32_t expected = isArray ? descriptor.stride : descriptor.bytes;
  if (argument.elementBytes_ == expected) return;
  fail((isArray ? "has elements of " : "is a struct of ") + std::to_string(expected) + " bytes, but " + given() +
       " has elements of " + std::to_string(argument.elementBytes_));
}

void KernelArguments::write(const Descriptor& descriptor, const Argument& argument) const {
  const Device::Impl& device = *kernel_->device_;
  VkDescriptorBufferInfo buffer{};
  if (argument.buffer_ != nullptr) {
    const VkDeviceSize limit = device.properties.limits.maxStorageBufferRange;
    buffer = {argument.buffer_->get(), 0, std::min(argument.buffer_->capacity(), limit)};
  }
  const VkDescriptorImageInfo image{argument.sampler_, argument.image_, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set_,
                                   .dstBinding = descriptor.binding,
                                   .descriptorCount = 1,
                                   .descriptorType = descriptor.type,
                                   .pImageInfo = &image,
                                   .pBufferInfo = &buffer,
                                   .pTexelBufferView = &argument.texels_};
  device.vk.UpdateDescriptorSets(device.device(), 1, &write, 0, nullptr);
}

void KernelArguments::set(std::initializer_list<Argument> arguments) {
  const std::vector<Descriptor>& descriptors = kernel_->interface_.descriptors;
  std::vector<const Argument*> given(descriptors.size());
  for (const Argument& argument : arguments) {
    const auto descriptor = std::find_if(descriptors.begin(), descriptors.end(),
                                         [&](const Descriptor& d) { return d.binding == argument.binding_; });
    if (descriptor == descriptors.end()) {
      throw Error("kernel \"" + kernel_->name_ + "\" has no binding " + std::to_string(argument.binding_));
    }
    const Argument*& here = given[static_cast<size_t>(descriptor - descriptors.begin())];
    if (here != nullptr) throw Error(kernel_->describe(*descriptor) + " is given twice");
    check(*descriptor, argument);
    here = &argument;
  }
  for (size_t i = 0; i < given.size(); ++i) {
    if (given[i] == nullptr) throw Error(kernel_->describe(descriptors[i]) + " is missing");
  }
  for (size_t i = 0; i < given.size(); ++i) {
    // An image is always written: its view may have the handle of one that was destroyed.
    const uint64_t identity = given[i]->buffer_ == nullptr ? 0 : given[i]->buffer_->identity();
    if (identity != 0 && identity == bound_[i]) continue;
    write(descriptors[i], *given[i]);
    bound_[i] = identity;
  }
  complete_ = true;
}

void KernelArguments::checkDispatch(PushBytes push) const {
  if (!complete_) throw Error("kernel \"" + kernel_->name_ + "\" is used before its arguments were set");
  if (push.size() != kernel_->interface_.pushBytes) {
    throw Error("kernel \"" + kernel_->name_ + "\" has push constants of " +
                std::to_string(kernel_->interface_.pushBytes) + " bytes, but was given " + std::to_string(push.size()));
  }
}

void KernelArguments::bind(const Commands& commands, PushBytes push) const {
  const VkPipelineLayout layout = kernel_->layout_.get();
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, kernel_->pipeline_.get());
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set_, 0, nullptr);
  if (push.empty()) return;
  commands->CmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, static_cast<uint32_t>(push.size()),
                             push.data());
}

void KernelArguments::bindForDraws(const Commands& commands) const {
  assert(kernel_->stage_ == VK_SHADER_STAGE_VERTEX_BIT);
  checkDispatch({});
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel_->pipeline_.get());
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, kernel_->layout_.get(), 0, 1, &set_, 0,
                                  nullptr);
}

void KernelArguments::record(const Commands& commands, uint32_t groups, PushBytes push) const {
  checkDispatch(push);
  if (groups == 0) return;
  bind(commands, push);
  const uint32_t rows = groupsFor(groups, kMaxGroupsPerAxis);
  assert(rows <= kMaxGroupsPerAxis);
  // Rows of equal length: fewer workgroups than there are rows run in excess.
  commands->CmdDispatch(commands, groupsFor(groups, rows), rows, 1);
}

void KernelArguments::recordIndirect(const Commands& commands, const Buffer& buffer, VkDeviceSize offset,
                                     PushBytes push) const {
  checkDispatch(push);
  assert(offset % 4 == 0 && offset + sizeof(VkDispatchIndirectCommand) <= buffer.capacity());
  bind(commands, push);
  commands->CmdDispatchIndirect(commands, buffer.get(), offset);
}

}  // namespace radar::gpu
