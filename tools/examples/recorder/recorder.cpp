// Crates fall on the ground and on each other, and never touch. In each frame a shader asks how far each may fall, the
// engine answers, and a shader moves them, in one command buffer on the host's device. The CPU reads nothing before the
// end, when it checks that all lie still.
#include <algorithm>
#include <cmath>
#include <cstdio>

#define VULKAN_HPP_NO_CONSTRUCTORS
#include <vulkan/vulkan_raii.hpp>

#include <radar/cpu_sweeper.h>
#include <radar/recorder.h>

#include "ask_comp.h"
#include "move_comp.h"

namespace {

constexpr uint32_t kFrames = 200, kFramesInFlight = 2;

// What the shaders are told, and what they bind.
struct Constants {
  uint32_t crates = 64, mesh = 0;
  float fall = 1, gap = 0.015625f;  // at most in a frame; left between what would touch
};
enum { kTransforms, kQueries, kResults, kBindings };

// Stands for a renderer's own set-up: a device with what the engine requires.
vk::raii::Device makeDevice(const vk::raii::Instance& instance, radar::HostDevice& host) {
  host = radar::hostOf(*instance);
  radar::Requirements needed = radar::requirements(host);
  const float priority = 1;
  const vk::DeviceQueueCreateInfo queue{
      .queueFamilyIndex = host.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
  const vk::DeviceCreateInfo info{.pNext = needed.chain(), .queueCreateInfoCount = 1, .pQueueCreateInfos = &queue};
  vk::raii::Device device(vk::raii::PhysicalDevice(instance, host.physicalDevice), info);
  host.device = *device;
  host.queue = *device.getQueue(host.queueFamily, 0);
  return device;
}

// For the shaders, the engine and the CPU. A renderer would keep most buffers in the device's own memory.
struct Buffer {
  Buffer(const vk::raii::Device& device, const vk::PhysicalDeviceMemoryProperties& has, size_t bytes)
      : handle(device, vk::BufferCreateInfo{.size = bytes,
                                            .usage = vk::BufferUsageFlagBits::eStorageBuffer |
                                                     vk::BufferUsageFlags(radar::kHostBufferUsage)}) {
    const vk::MemoryRequirements needed = handle.getMemoryRequirements();
    const auto wanted = vk::MemoryPropertyFlagBits::eHostVisible | vk::MemoryPropertyFlagBits::eHostCoherent;
    uint32_t type = 0;
    while ((needed.memoryTypeBits >> type & 1) == 0 || (has.memoryTypes[type].propertyFlags & wanted) != wanted) ++type;
    memory = device.allocateMemory({.allocationSize = needed.size, .memoryTypeIndex = type});
    handle.bindMemory(*memory, 0);
    floats = static_cast<float*>(memory.mapMemory(0, bytes));
  }
  vk::raii::DeviceMemory memory = nullptr;
  vk::raii::Buffer handle;
  float* floats;
};

// What was recorded before and accesses memory as `first` happens before what is recorded later and does as `then`.
void barrier(const vk::raii::CommandBuffer& commands, radar::Access first, radar::Access then) {
  const vk::MemoryBarrier2 memory{.srcStageMask = vk::PipelineStageFlags2(first.stages),
                                  .srcAccessMask = vk::AccessFlags2(first.access),
                                  .dstStageMask = vk::PipelineStageFlags2(then.stages),
                                  .dstAccessMask = vk::AccessFlags2(then.access)};
  commands.pipelineBarrier2({.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
}
constexpr radar::Access kReads = radar::Recorder::kReads, kWrites = radar::Recorder::kWrites;
constexpr radar::Access kEngine{kReads.stages | kWrites.stages, kWrites.access};
constexpr radar::Access kShader{VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT,
                                VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT};
constexpr radar::Access kCpu{VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT};

class Crates {
 public:
  Crates(const vk::raii::PhysicalDevice& physical, const vk::raii::Device& device, const radar::HostDevice& host)
      : device_(device),
        queue_(device, host.queueFamily, 0),
        transforms_(device, physical.getMemoryProperties(), constants_.crates * sizeof(VkTransformMatrixKHR)),
        queries_(device, physical.getMemoryProperties(), constants_.crates * sizeof(radar::HostQuery)),
        engine_(radar::Device::adopt(host)) {
    makeScene();
    makePipelines();
    makeFrames(host.queueFamily);
  }

  void frame(uint32_t number) {
    Frame& frame = frames_[number % kFramesInFlight];
    finish(frame);
    device_.resetFences(*frame.done);
    record(frame);
    queue_.submit(vk::SubmitInfo{.commandBufferCount = 1, .pCommandBuffers = &*frame.commands}, *frame.done);
  }

  // Whether each crate lies on something and touches nothing.
  bool lieStill() {
    for (const Frame& frame : frames_) finish(frame);
    std::vector<radar::Query> down;
    for (radar::ObjectId id = 0; id < constants_.crates; ++id) {
      radar::Transform pose;
      std::copy_n(transforms_.floats + 12 * id, 12, pose.m.begin());
      scene_.setTransform(id, pose);
      down.push_back(
          {.mesh = constants_.mesh, .worldFromMesh = pose, .direction = {0, 0, -1}, .distance = 1, .exclude = {id}});
    }
    const std::vector<radar::Result> results = radar::CpuSweeper(scene_).run(down).results;
    return std::ranges::all_of(results, [&](const radar::Result& result) {
      return result.status == radar::Status::hit && result.lo > 0 && result.hi < 2 * constants_.gap;
    });
  }

 private:
  struct Frame {
    radar::Recorder recorder;  // each has a buffer of answers of its own
    vk::raii::DescriptorSet set;
    vk::raii::CommandBuffer commands;
    vk::raii::Fence done;
  };

  // The commands of a frame.
  void record(Frame& frame) {
    const vk::raii::CommandBuffer& commands = frame.commands;
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    barrier(commands, kEngine, kShader);  // after the last frame
    run(frame, ask_);
    barrier(commands, kShader, kReads);
    const radar::MovedObjects crates{.transforms = *transforms_.handle, .count = constants_.crates};
    const radar::HostQueries queries{.buffer = *queries_.handle, .count = constants_.crates};
    frame.recorder.record(*commands, queries, {.objects = {&crates, 1}});
    barrier(commands, kEngine, kShader);
    run(frame, move_);
    barrier(commands, kShader, kCpu);
    commands.end();
  }

  void run(const Frame& frame, const vk::raii::Pipeline& pipeline) {
    frame.commands.bindPipeline(vk::PipelineBindPoint::eCompute, *pipeline);
    frame.commands.bindDescriptorSets(vk::PipelineBindPoint::eCompute, *layout_, 0, *frame.set, nullptr);
    frame.commands.pushConstants<Constants>(*layout_, vk::ShaderStageFlagBits::eCompute, 0, constants_);
    frame.commands.dispatch((constants_.crates + 63) / 64, 1, 1);
  }

  void finish(const Frame& frame) {
    if (device_.waitForFences(*frame.done, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess)
      throw radar::Error("vkWaitForFences failed");
  }

  void makeScene() {
    std::vector<float> corners;
    for (int i = 0; i < 8; ++i)
      corners.insert(corners.end(), {i & 1 ? 0.5f : -0.5f, i & 2 ? 0.5f : -0.5f, i & 4 ? 0.3f : -0.3f});
    const uint32_t triangles[] = {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                  2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};
    constants_.mesh = scene_.addMesh(corners, triangles);
    for (uint32_t i = 0; i < constants_.crates; ++i) {
      const float tilt = 0.05f * static_cast<float>(i % 7), c = std::cos(tilt), s = std::sin(tilt);
      const float x = 0.8f * static_cast<float>(i % 4), y = 0.7f * static_cast<float>(i / 4 % 4);
      const float rows[] = {1, 0, 0, x, 0, c, -s, y, 0, s, c, 3 + 1.6f * static_cast<float>(i)};
      std::copy_n(rows, 12, transforms_.floats + 12 * i);
      scene_.addObject({.mesh = constants_.mesh});
    }
    scene_.addObject({.mesh = constants_.mesh, .worldFromMesh = {{40, 0, 0, 0, 0, 40, 0, 0, 0, 0, 1, 0}}});
  }

  void makePipelines() {
    std::array<vk::DescriptorSetLayoutBinding, kBindings> bindings;
    for (uint32_t i = 0; i < kBindings; ++i) {
      bindings[i] = {.binding = i,
                     .descriptorType = vk::DescriptorType::eStorageBuffer,
                     .descriptorCount = 1,
                     .stageFlags = vk::ShaderStageFlagBits::eCompute};
    }
    sets_ = device_.createDescriptorSetLayout({.bindingCount = kBindings, .pBindings = bindings.data()});
    const vk::PushConstantRange range{vk::ShaderStageFlagBits::eCompute, 0, sizeof(Constants)};
    layout_ = device_.createPipelineLayout(
        {.setLayoutCount = 1, .pSetLayouts = &*sets_, .pushConstantRangeCount = 1, .pPushConstantRanges = &range});
    const auto make = [&](std::span<const uint32_t> code) {
      const vk::raii::ShaderModule module(
          device_, vk::ShaderModuleCreateInfo{.codeSize = code.size_bytes(), .pCode = code.data()});
      const vk::PipelineShaderStageCreateInfo stage{
          .stage = vk::ShaderStageFlagBits::eCompute, .module = *module, .pName = "main"};
      return device_.createComputePipeline(nullptr, {.stage = stage, .layout = *layout_});
    };
    ask_ = make(k_ask_comp);
    move_ = make(k_move_comp);
  }

  void makeFrames(uint32_t queueFamily) {
    const vk::DescriptorPoolSize size{vk::DescriptorType::eStorageBuffer, kBindings * kFramesInFlight};
    setPool_ = device_.createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                             .maxSets = kFramesInFlight,
                                             .poolSizeCount = 1,
                                             .pPoolSizes = &size});
    commandPool_ = device_.createCommandPool(
        {.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer, .queueFamilyIndex = queueFamily});
    for (uint32_t i = 0; i < kFramesInFlight; ++i) {
      radar::Recorder recorder(copy_, {.queries = constants_.crates});
      auto set = std::move(device_.allocateDescriptorSets(
          {.descriptorPool = *setPool_, .descriptorSetCount = 1, .pSetLayouts = &*sets_})[0]);
      const VkBuffer buffers[kBindings] = {*transforms_.handle, *queries_.handle, recorder.results()};
      for (uint32_t k = 0; k < kBindings; ++k) {
        const vk::DescriptorBufferInfo buffer{buffers[k], 0, VK_WHOLE_SIZE};
        device_.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *set,
                                                            .dstBinding = k,
                                                            .descriptorCount = 1,
                                                            .descriptorType = vk::DescriptorType::eStorageBuffer,
                                                            .pBufferInfo = &buffer},
                                     nullptr);
      }
      auto commands =
          std::move(device_.allocateCommandBuffers({.commandPool = *commandPool_, .commandBufferCount = 1})[0]);
      frames_.push_back({std::move(recorder), std::move(set), std::move(commands),
                         device_.createFence({.flags = vk::FenceCreateFlagBits::eSignaled})});
    }
  }

  const vk::raii::Device& device_;
  vk::raii::Queue queue_;
  Constants constants_;
  Buffer transforms_, queries_;
  vk::raii::DescriptorSetLayout sets_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline ask_ = nullptr, move_ = nullptr;
  vk::raii::DescriptorPool setPool_ = nullptr;
  vk::raii::CommandPool commandPool_ = nullptr;
  radar::Device engine_;
  radar::Scene scene_;
  radar::SceneCopy copy_{engine_, scene_};
  std::vector<Frame> frames_;
};

}  // namespace

int main() try {
  const vk::raii::Context loader;
  const vk::ApplicationInfo application{.apiVersion = VK_API_VERSION_1_3};
  const vk::raii::Instance instance(loader, vk::InstanceCreateInfo{.pApplicationInfo = &application});
  radar::HostDevice host;
  const vk::raii::Device device = makeDevice(instance, host);
  Crates crates(vk::raii::PhysicalDevice(instance, host.physicalDevice), device, host);
  for (uint32_t i = 0; i < kFrames; ++i) crates.frame(i);
  const bool lieStill = crates.lieStill();
  std::puts(lieStill ? "all crates lie still, and none touches anything" : "not all crates lie still");
  return lieStill ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "radar-example-recorder: %s\n", error.what());
  return 1;
}
