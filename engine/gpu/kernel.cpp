#include "gpu/kernel.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <map>
#include <mutex>
#include <string>

#include "gpu/api.h"
#include "shaders/shared/interop.h"

namespace radar::gpu {

namespace {

// Every device takes this many workgroups along each axis.
constexpr uint32_t kMostGroupsPerAxis = 65535;

DescriptorSetLayout makeSetLayout(const Device::Impl& device, const Shader& shader) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (const Binding& binding : shader.bindings) {
    bindings.push_back({.binding = binding.number,
                        .descriptorType = binding.type,
                        .descriptorCount = 1,
                        .stageFlags = VkShaderStageFlags(shader.stage)});
  }
  const VkDescriptorSetLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                             .bindingCount = static_cast<uint32_t>(bindings.size()),
                                             .pBindings = bindings.data()};
  return {device, info, shader.name};
}

PipelineLayout makePipelineLayout(const Device::Impl& device, VkDescriptorSetLayout setLayout, const Shader& shader) {
  const VkPushConstantRange range{VkShaderStageFlags(shader.stage), 0, shader.pushBytes};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &setLayout,
                                        .pushConstantRangeCount = shader.pushBytes > 0 ? 1u : 0u,
                                        .pPushConstantRanges = &range};
  return {device, info, shader.name};
}

// A pool for one set.
DescriptorPool makePool(const Device::Impl& device, const Shader& shader) {
  std::vector<VkDescriptorPoolSize> sizes;
  for (const Binding& binding : shader.bindings) sizes.push_back({binding.type, 1});
  const VkDescriptorPoolCreateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO,
                                        .maxSets = 1,
                                        .poolSizeCount = static_cast<uint32_t>(sizes.size()),
                                        .pPoolSizes = sizes.data()};
  return {device, info, shader.name};
}

}  // namespace

struct Kernel {
  Kernel(const Device::Impl& device, const Program& program);
  DescriptorSetLayout setLayout;
  PipelineLayout layout;
  Pipeline pipeline;
};

Kernel::Kernel(const Device::Impl& device, const Program& program)
    : setLayout(makeSetLayout(device, *program.shader)),
      layout(makePipelineLayout(device, setLayout.get(), *program.shader)) {
  const Shader& shader = *program.shader;
  const std::span<const uint32_t> spirv =
      device.doubles || shader.spirvWithoutDoubles.empty() ? shader.spirv : shader.spirvWithoutDoubles;
  if (shader.stage == VK_SHADER_STAGE_VERTEX_BIT) {
    pipeline = depthPipeline(device, layout.get(), spirv, shader.name);
    return;
  }
  std::array<uint32_t, Program::kMostConstants + 1> constants;
  std::copy(program.constants.begin(), program.constants.end(), constants.begin());
  constants.back() = device.dividesRight ? 1 : 0;
  pipeline = computePipeline(device, layout.get(), spirv, shader.name, constants, program.subgroups);
}

namespace {

double valueOf(const VkPipelineExecutableStatisticKHR& statistic) {
  switch (statistic.format) {
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_BOOL32_KHR:
      return statistic.value.b32;
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_INT64_KHR:
      return static_cast<double>(statistic.value.i64);
    case VK_PIPELINE_EXECUTABLE_STATISTIC_FORMAT_UINT64_KHR:
      return static_cast<double>(statistic.value.u64);
    default:
      return statistic.value.f64;
  }
}

// A device's.
class Kernels {
 public:
  explicit Kernels(const Device::Impl& device) : device_(device) {}
  const Kernel& of(const Program& program) const {
    const std::lock_guard lock(mutex_);
    return made_.try_emplace(program, device_, program).first->second;
  }

 private:
  const Device::Impl& device_;
  mutable std::mutex mutex_;
  mutable std::map<Program, Kernel> made_;
};

[[noreturn]] void fail(const Shader& shader, const std::string& what) {
  throw Error(Error::Kind::internal, std::string("shader \"") + shader.name + "\"" + what);
}

[[noreturn]] void fail(const Shader& shader, const Binding& binding, const std::string& what) {
  fail(shader, ", binding " + std::to_string(binding.number) + " (" + binding.name + ") " + what);
}

}  // namespace

void compile(const Device::Impl& device, const Program& program) {
  device.shared<Kernels>().of(program);
}

KernelReport reportOf(const Device::Impl& device, const Program& program) {
  const auto start = std::chrono::steady_clock::now();
  const Kernel kernel(device, program);
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  KernelReport report{.name = program.shader->name, .milliseconds = time.count()};
  if (!device.capturesStatistics) return report;
  const VkPipelineExecutableInfoKHR executable{.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_INFO_KHR,
                                               .pipeline = kernel.pipeline.get()};
  uint32_t count = 0;
  const auto get = [&](VkPipelineExecutableStatisticKHR* out) {
    check(device.vk.GetPipelineExecutableStatisticsKHR(device.device(), &executable, &count, out),
          "vkGetPipelineExecutableStatisticsKHR", program.shader->name);
  };
  get(nullptr);
  std::vector<VkPipelineExecutableStatisticKHR> statistics(
      count, {.sType = VK_STRUCTURE_TYPE_PIPELINE_EXECUTABLE_STATISTIC_KHR});
  get(statistics.data());
  for (const VkPipelineExecutableStatisticKHR& statistic : statistics) {
    report.statistics.push_back({statistic.name, statistic.description, valueOf(statistic)});
  }
  return report;
}

Passes::Passes(const Device::Impl& device, std::initializer_list<Program> programs) : device_(&device) {
  reserve(programs);
}

void Passes::reserve(std::initializer_list<Program> programs) {
  for (const Program& program : programs) {
    const auto isSame = [&](const Program& other) { return other == program; };
    const auto wanted = std::count_if(programs.begin(), programs.end(), isSame);
    while (std::ranges::count_if(sets_, isSame, &Set::program) < wanted) add(program);
  }
}

Passes::Set& Passes::add(const Program& program) {
  const Shader& shader = *program.shader;
  Set set{.program = program, .kernel = &device_->shared<Kernels>().of(program), .pool = makePool(*device_, shader)};
  const VkDescriptorSetLayout layout = set.kernel->setLayout.get();
  const VkDescriptorSetAllocateInfo info{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                         .descriptorPool = set.pool.get(),
                                         .descriptorSetCount = 1,
                                         .pSetLayouts = &layout};
  check(device_->vk.AllocateDescriptorSets(device_->device(), &info, &set.handle), "vkAllocateDescriptorSets",
        shader.name);
  device_->setName(VK_OBJECT_TYPE_DESCRIPTOR_SET, set.handle, shader.name);
  sets_.push_back(std::move(set));
  return sets_.back();
}

void Passes::write(Set& set, const Binding& binding, const Argument& argument) const {
  VkDescriptorBufferInfo buffer{};
  VkDescriptorImageInfo image{};
  VkBufferView texels = VK_NULL_HANDLE;
  if (argument.buffer_ != nullptr) {
    const VkDeviceSize limit = device_->properties.limits.maxStorageBufferRange;
    buffer = {argument.buffer_->get(), 0, std::min(argument.buffer_->capacity(), limit)};
    texels = argument.buffer_->view();
  } else {
    image = {argument.sampler_, argument.image_->view(), VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL};
  }
  const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                   .dstSet = set.handle,
                                   .dstBinding = binding.number,
                                   .descriptorCount = 1,
                                   .descriptorType = binding.type,
                                   .pImageInfo = &image,
                                   .pBufferInfo = &buffer,
                                   .pTexelBufferView = &texels};
  device_->vk.UpdateDescriptorSets(device_->device(), 1, &write, 0, nullptr);
}

const Passes::Set& Passes::setFor(const Program& program, std::initializer_list<Argument> arguments) {
  const Shader& shader = *program.shader;
  const std::span<const Binding> bindings = shader.bindings;
  std::array<const Argument*, kMostBindings> byNumber{}, given{};
  for (const Argument& argument : arguments) byNumber.at(argument.binding_) = &argument;
  std::array<uint64_t, kMostBindings> wanted{};
  for (size_t i = 0; i < bindings.size(); ++i) {
    given[i] = byNumber.at(bindings[i].number);
    if (given[i] == nullptr) fail(shader, bindings[i], "is missing");
    wanted[i] = given[i]->identity();
  }
  if (arguments.size() != bindings.size()) fail(shader, " binds something else, or is given something twice");
  Set* unused = nullptr;
  for (Set& set : sets_) {
    if (set.program != program) continue;
    if (set.bound == wanted) {
      set.recording = recording_;
      return set;
    }
    if (set.recording != recording_) unused = &set;
  }
  for (size_t i = 0; i < bindings.size(); ++i) {
    const bool wantsImage = bindings[i].type == VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    const bool wantsTexels = bindings[i].type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER;
    if (wantsImage != (given[i]->image_ != nullptr)) {
      fail(shader, bindings[i], wantsImage ? "is an image, not a buffer" : "is not an image");
    }
    if (wantsTexels && given[i]->buffer_->view() == VK_NULL_HANDLE) {
      fail(shader, bindings[i], std::string("reads texels, but \"") + given[i]->buffer_->name() + "\" has none");
    }
  }
  Set& set = unused != nullptr ? *unused : add(program);
  for (size_t i = 0; i < bindings.size(); ++i) {
    if (set.bound[i] != wanted[i]) write(set, bindings[i], *given[i]);
  }
  set.bound = wanted;
  set.recording = recording_;
  return set;
}

void Passes::dispatch(const Commands& commands, const Program& program, const Groups& groups, Bytes push,
                      std::initializer_list<Argument> arguments) {
  const Shader& shader = *program.shader;
  assert(shader.stage == VK_SHADER_STAGE_COMPUTE_BIT);
  if (push.size() != shader.pushBytes) {
    fail(shader, " has push constants of " + std::to_string(shader.pushBytes) + " bytes, but was given " +
                     std::to_string(push.size()));
  }
  const Set& set = setFor(program, arguments);
  if (groups.commands == nullptr && groups.count == 0) return;
  const VkPipelineLayout layout = set.kernel->layout.get();
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, set.kernel->pipeline.get());
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, layout, 0, 1, &set.handle, 0, nullptr);
  if (!push.empty()) {
    commands->CmdPushConstants(commands, layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, shader.pushBytes, push.data());
  }
  if (groups.commands != nullptr) {
    assert(groups.offset % 4 == 0 && groups.offset + sizeof(VkDispatchIndirectCommand) <= groups.commands->capacity());
    commands->CmdDispatchIndirect(commands, groups.commands->get(), groups.offset);
    return;
  }
  const uint32_t rows = groupsFor(groups.count, kMostGroupsPerAxis);
  assert(rows <= kMostGroupsPerAxis);
  // Rows of equal length: fewer workgroups than there are rows run in excess.
  commands->CmdDispatch(commands, groupsFor(groups.count, rows), rows, 1);
}

void Passes::bindForDraws(const Commands& commands, const Program& program, std::initializer_list<Argument> arguments) {
  assert(program.shader->stage == VK_SHADER_STAGE_VERTEX_BIT && program.shader->pushBytes == 0);
  const Set& set = setFor(program, arguments);
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, set.kernel->pipeline.get());
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, set.kernel->layout.get(), 0, 1,
                                  &set.handle, 0, nullptr);
}

}  // namespace radar::gpu
