// The agents on the device, and the engine that answers them: all that a renderer adds to its frames to ask how far
// something may move.
#pragma once

#include "gpu.h"
#include "spirv/ask_comp.h"
#include "spirv/move_comp.h"
#include "world.h"

namespace example {

inline constexpr uint32_t kFramesInFlight = 2;

/// `slot`, in all calls: which of the frames in flight is recorded; its last one has executed and been waited for.
class Agents {
 public:
  Agents(const Gpu& gpu, World& world)
      : gpu_(gpu), world_(world), device_(radar::Device::adopt(gpu.host)), copy_(device_, world.scene) {
    push.agents = static_cast<uint32_t>(world.agents.size());
    push.mesh = world.agentMesh;
    push.city = world.half;
    makeBuffers();
    makeLayout();
    ask_ = makeCompute(gpu_, *layout_, k_ask_comp);
    move_ = makeCompute(gpu_, *layout_, k_move_comp);
    for (uint32_t i = 0; i < kFramesInFlight; ++i) slots_.push_back(makeSlot());
  }

  /// One frame: agents ask, the engine answers, and they move.
  void step(const vk::raii::CommandBuffer& commands, uint32_t slot) {
    ++push.frame;
    // What the previous frame has read is written again.
    barrier(commands, kCompute | kEngineReads | kVertex | kCopy, kCompute | kCopy);
    commands.fillBuffer(*buffers_[kAsked].handle, 0, VK_WHOLE_SIZE, 0);
    barrier(commands, kCopy, kCompute);
    dispatch(commands, slot, ask_);
    // The engine reads the queries, and where everything is, from the buffers that the shaders have written.
    barrier(commands, kCompute, kEngineReads);
    slots_[slot].recorder.record(*commands, queries_, {.objects = {&places_, 1}});
    barrier(commands, kEngineReads | kEngineWrites, kCompute);
    dispatch(commands, slot, move_);
    barrier(commands, kCompute, kVertex | kCopy);
    commands.copyBuffer(*buffers_[kAgents].handle, *slots_[slot].agents.handle,
                        vk::BufferCopy{.size = buffers_[kAgents].size});
    barrier(commands, kCopy, kCpu);
  }

  /// Once that has executed: counts the queries, and in some frames agents that touch or cross anything. The scene
  /// learns where they have gone, which keeps the search fast.
  void check(uint32_t slot, bool crossings) {
    const radar::AnswerCounts counts = slots_[slot].recorder.answerCounts();
    for (const uint32_t count : counts.byStatus) report.queries += count;
    report.unanswered += counts.of(radar::Status::invalid);
    if (!crossings) return;
    std::vector<Agent> now(push.agents);
    std::memcpy(now.data(), slots_[slot].agents.mapped, slots_[slot].agents.size);
    report.crossings += world_.crossings(now);
    ++report.checks;
  }
  struct {
    uint32_t queries = 0, unanswered = 0, checks = 0, crossings = 0;
  } report;

  vk::PipelineLayout layout() const { return *layout_; }
  void bind(const vk::raii::CommandBuffer& commands, uint32_t slot, vk::PipelineBindPoint point,
            const vk::raii::Pipeline& pipeline) const {
    commands.bindPipeline(point, *pipeline);
    commands.bindDescriptorSets(point, *layout_, 0, *slots_[slot].set, nullptr);
    commands.pushConstants<Push>(*layout_, kStages, 0, push);
  }

  Push push{};  ///< the constants of all shaders

 private:
  using Usage = vk::BufferUsageFlagBits;
  static constexpr vk::ShaderStageFlags kStages =
      vk::ShaderStageFlagBits::eCompute | vk::ShaderStageFlagBits::eAllGraphics;

  struct Slot {
    radar::Recorder recorder;
    vk::raii::DescriptorSet set;
    Buffer agents;  ///< read back
  };

  void makeBuffers() {
    const vk::BufferUsageFlags storage = Usage::eStorageBuffer,
                               read = storage | vk::BufferUsageFlags(radar::kHostBufferUsage);
    std::vector<vec3> vertices = world_.agent;
    vertices.insert(vertices.end(), world_.building.begin(), world_.building.end());
    buffers_[kVertices] = makeFilled(gpu_, vertices, storage);
    buffers_[kAgents] = makeFilled(gpu_, world_.agents, storage | Usage::eTransferSrc);
    buffers_[kTransforms] = makeFilled(gpu_, world_.transforms, read);
    buffers_[kAsked] = makeBuffer(gpu_, sizeof(uint32_t), read | Usage::eTransferDst);
    buffers_[kQueries] = makeBuffer(gpu_, push.agents * sizeof(radar::HostQuery), read);
    places_ = {.transforms = *buffers_[kTransforms].handle, .count = push.agents};
    queries_ = {.buffer = *buffers_[kQueries].handle, .count = push.agents, .countBuffer = *buffers_[kAsked].handle};
  }

  void makeLayout() {
    std::array<vk::DescriptorSetLayoutBinding, kBindings> bindings;
    for (uint32_t i = 0; i < kBindings; ++i) bindings[i] = {i, vk::DescriptorType::eStorageBuffer, 1, kStages, nullptr};
    setLayout_ = gpu_.device.createDescriptorSetLayout({.bindingCount = kBindings, .pBindings = bindings.data()});
    const vk::PushConstantRange range{kStages, 0, sizeof(Push)};
    layout_ = gpu_.device.createPipelineLayout(
        {.setLayoutCount = 1, .pSetLayouts = &*setLayout_, .pushConstantRangeCount = 1, .pPushConstantRanges = &range});
    const vk::DescriptorPoolSize size{vk::DescriptorType::eStorageBuffer, kBindings * kFramesInFlight};
    sets_ = gpu_.device.createDescriptorPool({.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                              .maxSets = kFramesInFlight,
                                              .poolSizeCount = 1,
                                              .pPoolSizes = &size});
  }

  Slot makeSlot() {
    radar::Recorder recorder(copy_, {.queries = push.agents});
    recorder.prepare(queries_, {.objects = {&places_, 1}});
    vk::raii::DescriptorSet set = std::move(gpu_.device.allocateDescriptorSets(
        {.descriptorPool = *sets_, .descriptorSetCount = 1, .pSetLayouts = &*setLayout_})[0]);
    for (uint32_t i = 0; i < kBindings; ++i) {
      // Each recorder has a buffer of answers of its own.
      const vk::Buffer buffer = i == kResults ? vk::Buffer(recorder.results()) : *buffers_[i].handle;
      const vk::DescriptorBufferInfo info{buffer, 0, VK_WHOLE_SIZE};
      gpu_.device.updateDescriptorSets(vk::WriteDescriptorSet{.dstSet = *set,
                                                              .dstBinding = i,
                                                              .descriptorCount = 1,
                                                              .descriptorType = vk::DescriptorType::eStorageBuffer,
                                                              .pBufferInfo = &info},
                                       nullptr);
    }
    return {std::move(recorder), std::move(set), makeBuffer(gpu_, buffers_[kAgents].size, Usage::eTransferDst)};
  }

  void dispatch(const vk::raii::CommandBuffer& commands, uint32_t slot, const vk::raii::Pipeline& pipeline) const {
    bind(commands, slot, vk::PipelineBindPoint::eCompute, pipeline);
    commands.dispatch((push.agents + 63) / 64, 1, 1);
  }

  const Gpu& gpu_;
  World& world_;
  radar::Device device_;
  radar::SceneCopy copy_;
  std::array<Buffer, kBindings> buffers_;
  vk::raii::DescriptorSetLayout setLayout_ = nullptr;
  vk::raii::DescriptorPool sets_ = nullptr;
  vk::raii::PipelineLayout layout_ = nullptr;
  vk::raii::Pipeline ask_ = nullptr, move_ = nullptr;
  // What the device writes, and the engine reads: where all agents are, and the queries.
  radar::MovedObjects places_;
  radar::HostQueries queries_;
  std::vector<Slot> slots_;
};

}  // namespace example
