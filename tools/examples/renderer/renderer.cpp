#include "renderer.h"

#include <cmath>

#include "spirv/line_frag.h"
#include "spirv/line_vert.h"
#include "spirv/mesh_frag.h"
#include "spirv/mesh_vert.h"

namespace example {

namespace {

constexpr uint32_t kCheckEvery = 50;
constexpr uint32_t kTimes = 6;

}  // namespace

Camera lookAt(const vec3& eye, const vec3& target, float aspect) {
  const auto cross = [](const vec3& a, const vec3& b) {
    return vec3{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  const auto unit = [](vec3 v) {
    const float length = std::hypot(v[0], v[1], v[2]);
    for (float& x : v) x /= length;
    return v;
  };
  const vec3 forward = unit({target[0] - eye[0], target[1] - eye[1], target[2] - eye[2]});
  const vec3 right = unit(cross(forward, {0, 0, 1})), up = cross(right, forward);
  const float zoom = 1.7f, near = 0.25f, far = 1500;
  const std::array<vec3, 4> rows{right, up, forward, forward};
  const vec4 scales{zoom / aspect, -zoom, far / (far - near), 1};  // Vulkan's y points down
  Camera camera{.clipFromWorld = {}, .eye = eye};
  for (size_t row = 0; row < 4; ++row) {
    float offset = row == 2 ? -near * scales[2] : 0;
    for (size_t k = 0; k < 3; ++k) {
      camera.clipFromWorld[4 * k + row] = scales[row] * rows[row][k];
      offset -= scales[row] * rows[row][k] * eye[k];
    }
    camera.clipFromWorld[12 + row] = offset;
  }
  return camera;
}

Renderer::Renderer(const Gpu& gpu, World& world, VkExtent2D size, const radar::OnProgress& onProgress)
    : gpu_(gpu), world_(world), agents_(gpu, world, onProgress) {
  std::vector<uint32_t> indices;
  for (const Model& model : world.models)
    indices.insert(indices.end(), model.mesh.indices.begin(), model.mesh.indices.end());
  indices_ = makeFilled(gpu, lifetime_, std::as_bytes(std::span(indices)), VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
  const VkPipelineLayout layout = agents_.layout();
  mesh_ = makeGraphics(gpu, lifetime_, layout, k_mesh_vert, k_mesh_frag, VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST);
  line_ = makeGraphics(gpu, lifetime_, layout, k_line_vert, k_line_frag, VK_PRIMITIVE_TOPOLOGY_LINE_LIST);
  for (Slot& slot : slots_) makeSlot(slot);
  resize(size);
  // Some drivers compile shaders when they first run.
  frame(lookAt({40, 40, 40}, {0, 0, 0}, 1), true, Lines::normals, {});
  finish();
  frames_ = 0;
  report_ = {};
}

Renderer::~Renderer() {
  vkDeviceWaitIdle(gpu_.device);
}

void Renderer::makeSlot(Slot& slot) {
  slot.commands = makeCommands(gpu_, lifetime_);
  const VkFenceCreateInfo fenceInfo{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  require(vkCreateFence(gpu_.device, &fenceInfo, nullptr, &slot.fence), "vkCreateFence");
  lifetime_.add(gpu_.device, slot.fence, vkDestroyFence);
  const VkQueryPoolCreateInfo timesInfo{
      .sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO, .queryType = VK_QUERY_TYPE_TIMESTAMP, .queryCount = kTimes};
  require(vkCreateQueryPool(gpu_.device, &timesInfo, nullptr, &slot.times), "vkCreateQueryPool");
  lifetime_.add(gpu_.device, slot.times, vkDestroyQueryPool);
}

void Renderer::resize(VkExtent2D size) {
  require(vkDeviceWaitIdle(gpu_.device), "vkDeviceWaitIdle");
  images_.end();
  size_ = size;
  samples_ = makeImage(gpu_, images_, size, kColour, kSamples, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  depth_ = makeImage(gpu_, images_, size, kDepth, kSamples, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  picture_ = makeImage(gpu_, images_, size, kColour, VK_SAMPLE_COUNT_1_BIT,
                       VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
}

void Renderer::frame(const Camera& camera, bool moves, Lines lines, const Output& output) {
  const uint32_t index = frames_++ % kFramesInFlight;
  Slot& slot = slots_[index];
  wait(index);
  agents_.push.clipFromWorld = camera.clipFromWorld;
  agents_.push.eye = camera.eye;
  slot.moved = moves;
  slot.done = output.done;
  slot.checked = output.check || frames_ % kCheckEvery == 0;
  uint32_t time = 0;
  const auto mark = [&] {
    vkCmdWriteTimestamp2(slot.commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, slot.times, time++);
  };

  const VkCommandBufferBeginInfo begin{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                       .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  require(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
  vkCmdResetQueryPool(slot.commands, slot.times, 0, kTimes);
  mark();
  if (moves) agents_.ask(slot.commands, index);
  mark();
  if (moves) agents_.search(slot.commands, index);
  mark();
  if (moves) agents_.move(slot.commands, index);
  mark();
  draw(slot.commands, index, lines);
  mark();
  if (output.record) output.record(slot.commands, picture_.handle);
  if (slot.checked) agents_.readBack(slot.commands, index);
  mark();
  require(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");

  const VkSemaphoreSubmitInfo acquired{
      .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, .semaphore = output.acquired, .stageMask = kBlitted.stage};
  const VkSemaphoreSubmitInfo drawn{
      .sType = VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO, .semaphore = output.drawn, .stageMask = kBlitted.stage};
  const VkCommandBufferSubmitInfo commands{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                           .commandBuffer = slot.commands};
  const VkSubmitInfo2 submit{.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2,
                             .waitSemaphoreInfoCount = output.acquired == VK_NULL_HANDLE ? 0u : 1u,
                             .pWaitSemaphoreInfos = &acquired,
                             .commandBufferInfoCount = 1,
                             .pCommandBufferInfos = &commands,
                             .signalSemaphoreInfoCount = output.drawn == VK_NULL_HANDLE ? 0u : 1u,
                             .pSignalSemaphoreInfos = &drawn};
  require(vkQueueSubmit2(gpu_.queue, 1, &submit, slot.fence), "vkQueueSubmit2");
  slot.pending = true;
}

void Renderer::draw(VkCommandBuffer commands, uint32_t slot, Lines lines) {
  barrier(commands, kComputed, kVertexRead);
  barrier(commands, samples_.handle, kColourDrawn, VK_IMAGE_LAYOUT_UNDEFINED, kColourDrawn,
          VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  barrier(commands, depth_.handle, kDepthDrawn, VK_IMAGE_LAYOUT_UNDEFINED, kDepthDrawn,
          VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, VK_IMAGE_ASPECT_DEPTH_BIT);
  barrier(commands, picture_.handle, {kCopyRead.stage | kBlitRead.stage, VK_ACCESS_2_NONE}, VK_IMAGE_LAYOUT_UNDEFINED,
          kColourDrawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  const VkRenderingAttachmentInfo colour{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                         .imageView = samples_.view,
                                         .imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .resolveMode = VK_RESOLVE_MODE_AVERAGE_BIT,
                                         .resolveImageView = picture_.view,
                                         .resolveImageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                         .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                         .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                         .clearValue = {.color = {.float32 = {0.731f, 0.81f, 0.868f, 1}}}};
  const VkRenderingAttachmentInfo depth{.sType = VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO,
                                        .imageView = depth_.view,
                                        .imageLayout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                        .loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR,
                                        .storeOp = VK_ATTACHMENT_STORE_OP_DONT_CARE,
                                        .clearValue = {.depthStencil = {1, 0}}};
  const VkRenderingInfo rendering{.sType = VK_STRUCTURE_TYPE_RENDERING_INFO,
                                  .renderArea = {{0, 0}, size_},
                                  .layerCount = 1,
                                  .colorAttachmentCount = 1,
                                  .pColorAttachments = &colour,
                                  .pDepthAttachment = &depth};
  vkCmdBeginRendering(commands, &rendering);
  const VkViewport viewport{0, 0, static_cast<float>(size_.width), static_cast<float>(size_.height), 0, 1};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &rendering.renderArea);
  vkCmdBindIndexBuffer(commands, indices_.handle, 0, VK_INDEX_TYPE_UINT32);
  uint32_t index = 0;
  int32_t vertex = 0;
  for (const Model& model : world_.models) {
    agents_.push.kind = model.kind;
    agents_.bind(commands, slot, VK_PIPELINE_BIND_POINT_GRAPHICS, mesh_);
    const auto count = static_cast<uint32_t>(model.mesh.indices.size());
    vkCmdDrawIndexed(commands, count, model.count, index, vertex, model.first);
    index += count;
    vertex += static_cast<int32_t>(model.mesh.vertices.size());
  }
  if (lines != Lines::none) {
    agents_.bind(commands, slot, VK_PIPELINE_BIND_POINT_GRAPHICS, line_);
    vkCmdDraw(commands, lines == Lines::contacts ? 2 : 4, agents_.push.agents, 0, 0);
  }
  vkCmdEndRendering(commands);
  barrier(commands, picture_.handle, kColourDrawn, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
          {kCopyRead.stage | kBlitRead.stage, VK_ACCESS_2_TRANSFER_READ_BIT}, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
}

void Renderer::wait(uint32_t index) {
  Slot& slot = slots_[index];
  if (!slot.pending) return;
  require(vkWaitForFences(gpu_.device, 1, &slot.fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  require(vkResetFences(gpu_.device, 1, &slot.fence), "vkResetFences");
  slot.pending = false;
  std::array<uint64_t, kTimes> ticks;
  require(vkGetQueryPoolResults(gpu_.device, slot.times, 0, kTimes, sizeof(ticks), ticks.data(), sizeof(uint64_t),
                                VK_QUERY_RESULT_64_BIT),
          "vkGetQueryPoolResults");
  const auto since = [&](size_t from, size_t to) {
    return static_cast<double>(ticks[to] - ticks[from]) * gpu_.nanosecondsPerTick * 1e-6;
  };
  if (slot.moved) {
    for (size_t i = 0; i + 1 < kTimes; ++i) report_.milliseconds[i].push_back(since(i, i + 1));
    report_.whole.push_back(since(0, kTimes - 1));
  }
  if (slot.done) slot.done();
  if (!slot.checked) return;
  const Agents::Check found = agents_.check(index);
  ++report_.checks;
  report_.crossings += found.crossings;
  report_.answered = found.answered;
  report_.refused = found.refused;
}

void Renderer::finish() {
  for (uint32_t i = 0; i < kFramesInFlight; ++i) wait((frames_ + i) % kFramesInFlight);
}

}  // namespace example
