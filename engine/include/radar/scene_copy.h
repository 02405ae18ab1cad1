// A scene's copy on a device, shared by what searches it there.
#pragma once

#include <memory>

#include "radar/device.h"
#include "radar/scene.h"

namespace radar {

/// A scene's copy on a device that several Sweepers and Recorders share, so that it takes memory once and each change
/// is uploaded once. One thread at a time uses them all. What they record and submit goes to one queue, in the order of
/// the calls of record() and run(); if a recording is not submitted, none made after it is: reset() their recorders.
/// Its buffers live as long as something needs them.
class RADAR_API SceneCopy {
 public:
  /// `device` and `scene` outlive it and what shares it.
  SceneCopy(const Device& device, const Scene& scene);
  ~SceneCopy();
  SceneCopy(SceneCopy&&) noexcept;
  SceneCopy& operator=(SceneCopy&&) noexcept;
  /// Bytes of its buffers on the device.
  uint64_t memoryUse() const;

  struct Impl;

 private:
  friend class Recorder;
  friend class Sweeper;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
