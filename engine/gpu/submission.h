// One command buffer at a time: begin, record, submit, wait; with timestamps between its stages on request.
#pragma once

#include <string>
#include <vector>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace radar::gpu {

/// Adds to the stage of that name, which is made if it is not there.
void addStageTime(std::vector<StageTime>& stages, const std::string& name, double ms);

class Submission {
 public:
  /// `device` has a queue.
  Submission(const Device::Impl& device, bool timestamps);

  Commands begin();
  /// Opens a stage: a debug label, and the end of the stage before it.
  void stage(const char* name);
  /// Hands what was recorded to the queue, and returns while the device works on it; wait() comes before anything else.
  void submit();
  /// Blocks until the device is done with what was submitted. Throws Error with VK_ERROR_DEVICE_LOST if it is lost.
  void wait();
  void submitAndWait();
  /// Adds the milliseconds of each stage of the last submission to those of its name; nothing without timestamps.
  void addTimes(std::vector<StageTime>& stages) const;

 private:
  static constexpr uint32_t kMaxStages = 32;
  void endStage();

  const Device::Impl* device_;
  bool timestamps_;
  CommandPool pool_;
  Commands commands_;
  Fence fence_;
  QueryPool queries_;
  std::vector<const char*> stages_;
  bool pending_ = false;
};

}  // namespace radar::gpu
