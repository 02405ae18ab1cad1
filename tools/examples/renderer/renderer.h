// Frames: the agents move, and all is drawn, in one command buffer.
#pragma once

#include <cstdio>
#include <functional>

#include "agents.h"
#include "spirv/mesh_frag.h"
#include "spirv/mesh_vert.h"

namespace example {

/// Copies or blits a frame's picture, which is in TRANSFER_SRC_OPTIMAL.
using Output = std::function<void(const vk::raii::CommandBuffer&, vk::Image)>;

class Renderer {
 public:
  Renderer(const Gpu& gpu, World& world, vk::Extent2D size)
      : gpu_(gpu), world_(world), agents_(gpu, world), size_(size) {
    using Usage = vk::ImageUsageFlagBits;
    samples_ = makeImage(gpu, size, kColour, kSamples, Usage::eColorAttachment);
    depth_ = makeImage(gpu, size, kDepth, kSamples, Usage::eDepthStencilAttachment);
    picture_ =
        makeImage(gpu, size, kColour, vk::SampleCountFlagBits::e1, Usage::eColorAttachment | Usage::eTransferSrc);
    mesh_ = makeGraphics(gpu, agents_.layout(), k_mesh_vert, k_mesh_frag, size);
    for (Slot& slot : slots_)
      slot = {std::move(gpu.device.allocateCommandBuffers({.commandPool = *gpu.pool, .commandBufferCount = 1})[0]),
              gpu.device.createFence({.flags = vk::FenceCreateFlagBits::eSignaled})};
  }
  ~Renderer() { gpu_.device.waitIdle(); }

  /// Records and submits a frame, which is drawn if it has an output; that waits for `acquired` and signals `drawn`, if
  /// they are given. The CPU checks the agents of each fiftieth.
  void frame(const Output& output, vk::Semaphore acquired = {}, vk::Semaphore drawn = {}) {
    const uint32_t index = frames_++ % kFramesInFlight;
    finish(index);
    Slot& slot = slots_[index];
    slot.number = frames_;
    gpu_.device.resetFences(*slot.done);
    slot.commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    agents_.step(slot.commands, index);
    if (output) {
      draw(slot.commands, index);
      output(slot.commands, *picture_.handle);
    }
    slot.commands.end();
    const vk::PipelineStageFlags blit = vk::PipelineStageFlagBits::eTransfer;
    const uint32_t shown = acquired ? 1 : 0;
    gpu_.queue.submit(vk::SubmitInfo{.waitSemaphoreCount = shown,
                                     .pWaitSemaphores = &acquired,
                                     .pWaitDstStageMask = &blit,
                                     .commandBufferCount = 1,
                                     .pCommandBuffers = &*slot.commands,
                                     .signalSemaphoreCount = shown,
                                     .pSignalSemaphores = &drawn},
                      *slot.done);
  }

  /// Waits for all frames, and says what they have shown.
  void finish() {
    for (uint32_t i = 0; i < kFramesInFlight; ++i) finish((frames_ + i) % kFramesInFlight);
    std::printf("queries: %u, without an answer: %u\nchecks by the CPU: %u, crossings: %u\n", agents_.report.queries,
                agents_.report.unanswered, agents_.report.checks, agents_.report.crossings);
  }

 private:
  struct Slot {
    vk::raii::CommandBuffer commands = nullptr;
    vk::raii::Fence done = nullptr;
    uint32_t number = 0;  ///< of the frame, from 1; 0: none
  };

  void finish(uint32_t index) {
    if (gpu_.device.waitForFences(*slots_[index].done, VK_TRUE, UINT64_MAX) != vk::Result::eSuccess)
      throw radar::Error("vkWaitForFences failed");
    const uint32_t number = std::exchange(slots_[index].number, 0);
    if (number != 0) agents_.check(index, number % 50 == 0);
  }

  void draw(const vk::raii::CommandBuffer& commands, uint32_t slot) {
    using Layout = vk::ImageLayout;
    const float around = 0.6f + 0.002f * static_cast<float>(frames_), away = std::min(1.1f * world_.half, 60.0f);
    agents_.push.eye = {0.88f * away * std::cos(around), 0.88f * away * std::sin(around), 5 + 0.48f * away};
    agents_.push.aspect = static_cast<float>(size_.width) / static_cast<float>(size_.height);
    barrier(commands, *samples_.handle, kColourDrawn, Layout::eUndefined, kColourDrawn,
            Layout::eColorAttachmentOptimal);
    barrier(commands, *depth_.handle, kDepthDrawn, Layout::eUndefined, kDepthDrawn,
            Layout::eDepthStencilAttachmentOptimal, vk::ImageAspectFlagBits::eDepth);
    barrier(commands, *picture_.handle, kCopy, Layout::eUndefined, kColourDrawn, Layout::eColorAttachmentOptimal);
    const vk::RenderingAttachmentInfo colour{
        .imageView = *samples_.view,
        .imageLayout = Layout::eColorAttachmentOptimal,
        .resolveMode = vk::ResolveModeFlagBits::eAverage,
        .resolveImageView = *picture_.view,
        .resolveImageLayout = Layout::eColorAttachmentOptimal,
        .loadOp = vk::AttachmentLoadOp::eClear,
        .clearValue = {.color = {.float32 = std::array{0.731f, 0.81f, 0.868f, 1.0f}}}};
    const vk::RenderingAttachmentInfo depth{.imageView = *depth_.view,
                                            .imageLayout = Layout::eDepthStencilAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eClear,
                                            .clearValue = {.depthStencil = {1, 0}}};
    commands.beginRendering({.renderArea = {{}, size_},
                             .layerCount = 1,
                             .colorAttachmentCount = 1,
                             .pColorAttachments = &colour,
                             .pDepthAttachment = &depth});
    agents_.bind(commands, slot, vk::PipelineBindPoint::eGraphics, mesh_);
    const auto ofAgent = static_cast<uint32_t>(world_.agent.size());
    const uint32_t agents = agents_.push.agents, objects = static_cast<uint32_t>(world_.transforms.size());
    commands.draw(ofAgent, agents, 0, 0);
    commands.draw(static_cast<uint32_t>(world_.building.size()), objects - agents, ofAgent, agents);
    commands.endRendering();
    barrier(commands, *picture_.handle, kColourDrawn, Layout::eColorAttachmentOptimal, kCopy,
            Layout::eTransferSrcOptimal);
  }

  const Gpu& gpu_;
  const World& world_;
  Agents agents_;
  vk::Extent2D size_;
  Image samples_, depth_, picture_;
  vk::raii::Pipeline mesh_ = nullptr;
  std::array<Slot, kFramesInFlight> slots_;
  uint32_t frames_ = 0;
};

}  // namespace example
