#include "agents.h"

#include <cstring>
#include <numeric>

#include "spirv/ask_comp.h"
#include "spirv/claim_comp.h"
#include "spirv/move_comp.h"
#include "spirv/skin_comp.h"

namespace example {

namespace {

constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_COMPUTE_BIT | VK_SHADER_STAGE_VERTEX_BIT;
constexpr VkDeviceSize kTransform = sizeof(std::array<float, 12>);
constexpr VkDeviceSize kHeader = 4 * sizeof(uint32_t);  // grid.glsl: counts, and the buckets after them

template <typename T>
std::vector<T> contentsOf(const Buffer& buffer) {
  std::vector<T> values(buffer.size / sizeof(T));
  std::memcpy(values.data(), buffer.mapped, values.size() * sizeof(T));
  return values;
}

}  // namespace

Agents::Agents(const Gpu& gpu, World& world, const radar::OnProgress& onProgress)
    : gpu_(gpu), world_(world), device_(radar::Device::adopt(gpu.handles())), copy_(device_, world.scene) {
  radar::prepare(device_, radar::Mode::contact, onProgress);
  push.agents = static_cast<uint32_t>(world.agents.size());
  push.walkers = world.walkers;
  push.walkerVertices = static_cast<uint32_t>(world.models[kWalker].mesh.vertices.size());
  push.city = world.half;
  moved_.resize(push.agents);
  std::iota(moved_.begin(), moved_.end(), 0u);
  makeBuffers();
  makeLayout();
  skin_ = makeCompute(gpu_, lifetime_, layout_, k_skin_comp);
  claim_ = makeCompute(gpu_, lifetime_, layout_, k_claim_comp);
  ask_ = makeCompute(gpu_, lifetime_, layout_, k_ask_comp);
  move_ = makeCompute(gpu_, lifetime_, layout_, k_move_comp);
  for (Slot& slot : slots_) makeSlot(slot);
}

void Agents::makeBuffers() {
  const VkBufferUsageFlags storage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
  // The engine copies what it reads; the check copies, too.
  const VkBufferUsageFlags read = storage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
  std::vector<vec4> vertices;
  for (const Model& model : world_.models)  // the walkers' is first: skin.comp relies on it
    vertices.insert(vertices.end(), model.mesh.vertices.begin(), model.mesh.vertices.end());
  const auto filled = [&](const auto& values, VkBufferUsageFlags usage) {
    return makeFilled(gpu_, lifetime_, std::as_bytes(std::span(values)), usage);
  };
  const auto empty = [&](VkDeviceSize bytes, VkBufferUsageFlags usage) {
    return makeBuffer(gpu_, lifetime_, bytes, usage, Where::device);
  };
  buffers_[kVertices] = filled(vertices, storage);
  buffers_[kAgents] = filled(world_.agents, read);
  buffers_[kTransforms] = filled(world_.transforms, read);
  buffers_[kGridCells] = filled(std::vector<uint32_t>(kHeader / sizeof(uint32_t) + kBuckets), read);
  buffers_[kClaims] = empty(push.agents * sizeof(Claim), storage);
  buffers_[kQueries] = empty(push.agents * sizeof(radar::HostQuery), read);
  const VkDeviceSize shape = push.walkerVertices * sizeof(vec3);
  buffers_[kSkinned] = empty(std::max<VkDeviceSize>(2 * push.walkers * shape, sizeof(vec3)), read);
  for (uint32_t i = 0; i < push.walkers; ++i) {
    for (uint32_t next = 0; next < 2; ++next) {
      const radar::HostPositions positions{.buffer = buffers_[kSkinned].handle, .first = (2 * i + next) * shape};
      deformed_.push_back({next == 0 ? world_.bodies[i] : world_.nextBodies[i], positions});
    }
  }
  places_ = {.transforms = buffers_[kTransforms].handle, .objects = moved_};
  queries_ = {.buffer = buffers_[kQueries].handle, .count = push.agents, .countBuffer = buffers_[kGridCells].handle};
}

void Agents::makeLayout() {
  std::array<VkDescriptorSetLayoutBinding, kBindings> bindings{};
  for (uint32_t i = 0; i < kBindings; ++i) bindings[i] = {i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 1, kStages, nullptr};
  const VkDescriptorSetLayoutCreateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO,
                                                .bindingCount = kBindings,
                                                .pBindings = bindings.data()};
  require(vkCreateDescriptorSetLayout(gpu_.device, &setInfo, nullptr, &setLayout_), "vkCreateDescriptorSetLayout");
  lifetime_.add(gpu_.device, setLayout_, vkDestroyDescriptorSetLayout);
  const VkPushConstantRange range{kStages | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)};
  const VkPipelineLayoutCreateInfo info{.sType = VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO,
                                        .setLayoutCount = 1,
                                        .pSetLayouts = &setLayout_,
                                        .pushConstantRangeCount = 1,
                                        .pPushConstantRanges = &range};
  require(vkCreatePipelineLayout(gpu_.device, &info, nullptr, &layout_), "vkCreatePipelineLayout");
  lifetime_.add(gpu_.device, layout_, vkDestroyPipelineLayout);
}

void Agents::makeSlot(Slot& slot) {
  slot.recorder.emplace(copy_, radar::Capacity{.queries = push.agents});
  slot.recorder->prepare(queries_, geometry());
  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, kBindings};
  const VkDescriptorPoolCreateInfo setsInfo{
      .sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO, .maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size};
  VkDescriptorPool sets;
  require(vkCreateDescriptorPool(gpu_.device, &setsInfo, nullptr, &sets), "vkCreateDescriptorPool");
  lifetime_.add(gpu_.device, sets, vkDestroyDescriptorPool);
  const VkDescriptorSetAllocateInfo setInfo{.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO,
                                            .descriptorPool = sets,
                                            .descriptorSetCount = 1,
                                            .pSetLayouts = &setLayout_};
  require(vkAllocateDescriptorSets(gpu_.device, &setInfo, &slot.set), "vkAllocateDescriptorSets");
  for (uint32_t i = 0; i < kBindings; ++i) {
    // Each recorder has a buffer of answers of its own.
    const VkBuffer buffer = i == kResults ? slot.recorder->results() : buffers_[i].handle;
    const VkDescriptorBufferInfo info{buffer, 0, VK_WHOLE_SIZE};
    const VkWriteDescriptorSet write{.sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET,
                                     .dstSet = slot.set,
                                     .dstBinding = i,
                                     .descriptorCount = 1,
                                     .descriptorType = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                                     .pBufferInfo = &info};
    vkUpdateDescriptorSets(gpu_.device, 1, &write, 0, nullptr);
  }
  const auto forCpu = [&](VkDeviceSize bytes) {
    return makeBuffer(gpu_, lifetime_, bytes, VK_BUFFER_USAGE_TRANSFER_DST_BIT, Where::host);
  };
  slot.transforms = forCpu(push.agents * kTransform);
  slot.skinned = forCpu(buffers_[kSkinned].size);
  slot.agents = forCpu(buffers_[kAgents].size);
  slot.counts = forCpu(kHeader);
}

void Agents::ask(VkCommandBuffer commands, uint32_t slot) {
  ++push.frame;
  const VkBuffer cells = buffers_[kGridCells].handle;
  // What the previous frame has read is written again.
  barrier(commands, {kCompute.stage | kCopyRead.stage | kVertexRead.stage, kComputed.access},
          {kCompute.stage | kFilled.stage, kCompute.access | kFilled.access});
  vkCmdFillBuffer(commands, cells, 0, sizeof(uint32_t), 0);
  vkCmdFillBuffer(commands, cells, kHeader, VK_WHOLE_SIZE, radar::kNone);
  barrier(commands, kFilled, kCompute);
  dispatch(commands, slot, skin_, 2 * push.walkers * push.walkerVertices);
  dispatch(commands, slot, claim_, push.agents);
  barrier(commands, kComputed, kCompute);
  dispatch(commands, slot, ask_, push.agents);
}

void Agents::search(VkCommandBuffer commands, uint32_t slot) {
  // The engine reads the queries, and where everything is, from the buffers that the shaders have written.
#ifndef RADAR_EXAMPLE_LEAVE_OUT_BARRIER  // a test leaves it out, and expects synchronization validation to notice
  barrier(commands, kComputed, kCopyRead);
#endif
  slots_[slot].recorder->record(commands, queries_, geometry());
}

void Agents::move(VkCommandBuffer commands, uint32_t slot) {
  barrier(commands, {kComputed.stage | kCopyRead.stage, kComputed.access}, kCompute);
  dispatch(commands, slot, move_, push.agents);
}

void Agents::readBack(VkCommandBuffer commands, uint32_t slot) {
  barrier(commands, kComputed, kCopyRead);
  Slot& to = slots_[slot];
  to.step = push.frame;
  const std::pair<uint32_t, const Buffer*> copies[] = {
      {kTransforms, &to.transforms}, {kSkinned, &to.skinned}, {kAgents, &to.agents}, {kGridCells, &to.counts}};
  for (const auto& [from, copy] : copies) {
    const VkBufferCopy all{.size = copy->size};
    vkCmdCopyBuffer(commands, buffers_[from].handle, copy->handle, 1, &all);
  }
  barrier(commands, kCopied, kHostRead);
}

Agents::Check Agents::check(uint32_t slot) {
  const Slot& from = slots_[slot];
  const std::vector<uint32_t> counts = contentsOf<uint32_t>(from.counts);
  const uint32_t crossings =
      world_.crossings(contentsOf<std::array<float, 12>>(from.transforms), contentsOf<vec3>(from.skinned),
                       contentsOf<Agent>(from.agents), from.step);
  return {crossings, counts[1], counts[2]};
}

void Agents::bind(VkCommandBuffer commands, uint32_t slot, VkPipelineBindPoint point, VkPipeline pipeline) const {
  vkCmdBindPipeline(commands, point, pipeline);
  vkCmdBindDescriptorSets(commands, point, layout_, 0, 1, &slots_[slot].set, 0, nullptr);
  vkCmdPushConstants(commands, layout_, kStages | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push), &push);
}

void Agents::dispatch(VkCommandBuffer commands, uint32_t slot, VkPipeline pipeline, uint32_t invocations) const {
  bind(commands, slot, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline);
  vkCmdDispatch(commands, (invocations + 63) / 64, 1, 1);
}

}  // namespace example
