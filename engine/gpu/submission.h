// One command buffer at a time: begin, record, submit, wait; optionally with timestamps between stages.
#pragma once

#include <string>
#include <vector>

#include "gpu/device.h"
#include "radar/radar.h"

namespace radar::gpu {

/// Adds to the stage of that name, creating it if needed.
void addStageTime(std::vector<StageTime>& stages, const std::string& name, double ms);

class Submission {
 public:
  /// `device` has a queue.
  Submission(const Device::Impl& device, bool timestamps);

  Commands begin();
  /// Ends the current stage and begins another, with a debug label.
  void stage(const char* name);
  /// Submits the recorded commands without waiting; call wait() before anything else.
  void submit();
  /// Blocks until the submission is done. Throws Error with VK_ERROR_DEVICE_LOST if the device is lost, or does not
  /// end: then nothing that the engine made on it is destroyed any more.
  void wait();
  void submitAndWait();
  /// Adds the milliseconds of the last submission's stages to those of the same name; nothing without timestamps.
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
