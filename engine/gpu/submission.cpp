#include "gpu/submission.h"

#include <algorithm>
#include <cassert>
#include <chrono>
#include <thread>

#include "gpu/api.h"
#include "gpu/barrier.h"

namespace radar::gpu {

namespace {

constexpr int kMostWaits = 100;  // five seconds in all
// Compiling shaders may be part of a submission, and takes some drivers minutes.
constexpr uint64_t kPatience = 600'000'000'000;  // nanoseconds

}  // namespace

Submission::Submission(const Device::Impl& device, bool timestamps)
    : device_(&device), timestamps_(timestamps && device.properties.limits.timestampComputeAndGraphics) {
  assert(device.host.queue != VK_NULL_HANDLE);
  const VkCommandPoolCreateInfo poolInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO,
                                         .flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                         .queueFamilyIndex = device.host.queueFamily};
  pool_ = {device, poolInfo};
  const VkCommandBufferAllocateInfo allocate{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             .commandPool = pool_.get(),
                                             .level = VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                             .commandBufferCount = 1};
  check(device.vk.AllocateCommandBuffers(device.device(), &allocate, &commands_.handle), "vkAllocateCommandBuffers");
  commands_.api = &device.vk;
  const VkFenceCreateInfo fenceInfo{.sType = VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  fence_ = {device, fenceInfo};
  if (!timestamps_) return;
  const VkQueryPoolCreateInfo queryInfo{.sType = VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO,
                                        .queryType = VK_QUERY_TYPE_TIMESTAMP,
                                        .queryCount = kMaxStages + 1};
  queries_ = {device, queryInfo};
}

Commands Submission::begin() {
  assert(!pending_);
  const VkCommandBufferBeginInfo info{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO,
                                      .flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(commands_->ResetCommandBuffer(commands_, 0), "vkResetCommandBuffer");  // an earlier recording may have failed
  check(commands_->BeginCommandBuffer(commands_, &info), "vkBeginCommandBuffer");
  stages_.clear();
  if (timestamps_) {
    commands_->CmdResetQueryPool(commands_, queries_.get(), 0, kMaxStages + 1);
    commands_->CmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(), 0);
  }
  return commands_;
}

void Submission::endStage() {
  if (stages_.empty()) return;
  device_->endLabel(commands_);
  if (!timestamps_) return;
  // Profiling only: without a full barrier, a timestamp may be written before the stage's work is done.
  everythingToEverything(commands_);
  commands_->CmdWriteTimestamp2(commands_, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, queries_.get(),
                                static_cast<uint32_t>(stages_.size()));
  everythingToEverything(commands_);
}

void Submission::stage(const char* name) {
  endStage();
  assert(stages_.size() < kMaxStages);
  stages_.push_back(name);
  device_->beginLabel(commands_, name);
}

void Submission::submit() {
  endStage();
  check(commands_->EndCommandBuffer(commands_), "vkEndCommandBuffer");
  const VkCommandBufferSubmitInfo commandInfo{.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO,
                                              .commandBuffer = commands_};
  const VkSubmitInfo2 submit{
      .sType = VK_STRUCTURE_TYPE_SUBMIT_INFO_2, .commandBufferInfoCount = 1, .pCommandBufferInfos = &commandInfo};
  // Here rather than after the wait, which may fail.
  const VkFence fence = fence_.get();
  check(device_->vk.ResetFences(device_->device(), 1, &fence), "vkResetFences");
  const HostDevice& host = device_->host;
  VkResult submitted;
  {
    const std::scoped_lock lock(device_->queueMutex);
    if (host.lockQueue) host.lockQueue();
    submitted = device_->vk.QueueSubmit2(host.queue, 1, &submit, fence);
    if (host.unlockQueue) host.unlockQueue();
  }
  check(submitted, "vkQueueSubmit2");
  pending_ = true;
}

void Submission::wait() {
  const VkFence fence = fence_.get();
  // A lack of memory says nothing about the device, which may still be at work.
  VkResult waited = VK_SUCCESS;
  for (int tries = 0; tries < kMostWaits; ++tries) {
    waited = device_->vk.WaitForFences(device_->device(), 1, &fence, VK_TRUE, kPatience);
    if (waited != VK_ERROR_OUT_OF_HOST_MEMORY && waited != VK_ERROR_OUT_OF_DEVICE_MEMORY) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(tries));
  }
  pending_ = false;
  if (waited == VK_ERROR_OUT_OF_HOST_MEMORY || waited == VK_ERROR_OUT_OF_DEVICE_MEMORY) {
    throw Error(std::string("vkWaitForFences: ") + resultName(waited) + ", again and again: expected the device to end",
                VK_ERROR_DEVICE_LOST);
  }
  if (waited == VK_TIMEOUT) {
    device_->abandoned = true;
    throw Error("vkWaitForFences: " + device_->name + " has not ended a submission in 10 minutes, and is given up",
                VK_ERROR_DEVICE_LOST);
  }
  check(waited, "vkWaitForFences");
}

void Submission::submitAndWait() {
  submit();
  wait();
}

void addStageTime(std::vector<StageTime>& stages, const std::string& name, double ms) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const StageTime& s) { return s.name == name; });
  if (found == stages.end()) {
    stages.push_back({name, ms});
  } else {
    found->ms += ms;
  }
}

void Submission::addTimes(std::vector<StageTime>& stages) const {
  if (!timestamps_ || stages_.empty()) return;
  std::vector<uint64_t> ticks(stages_.size() + 1);
  check(device_->vk.GetQueryPoolResults(device_->device(), queries_.get(), 0, static_cast<uint32_t>(ticks.size()),
                                        ticks.size() * sizeof(uint64_t), ticks.data(), sizeof(uint64_t),
                                        VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
        "vkGetQueryPoolResults");
  const double msPerTick = 1e-6 * device_->properties.limits.timestampPeriod;
  for (size_t i = 0; i < stages_.size(); ++i) {
    const double ms = msPerTick * static_cast<double>(ticks[i + 1] - ticks[i]);
    addStageTime(stages, stages_[i], ms);
  }
}

}  // namespace radar::gpu
