// A scene with what answers casts on it.
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "radar/cpu_sweeper.h"
#include "radar/pool.h"

namespace radar::python {

/// What answers, as the program's --device, --cpu-batch and --threads say it.
struct DeviceChoice {
  uint32_t device = kNone;                    ///< kNone: the best
  std::optional<std::vector<uint32_t>> pool;  ///< these devices share the work, instead of `device`; empty: all
  uint32_t cpuBatch = kNone;
  uint32_t threads = 0;
};

/// Devices are opened when a batch needs them first. One thread at a time may use a CastingScene.
class CastingScene {
 public:
  explicit CastingScene(DeviceChoice choice);
  ~CastingScene();

  const Scene& scene() const { return scene_; }
  /// Whether an object has a motion.
  bool moves() const;
  /// Every change is made here, since a pool must know of it.
  void edit(const std::function<void(Scene&)>& change);

  /// Answers on the CPU alone or as chosen. Throws Error as Sweeper::run and Pool::submit do, or if no device is
  /// usable.
  Answers answer(const std::vector<Query>& queries, Mode mode, bool onCpu);

  std::span<const Device> devices() const;

 private:
  struct Answerers;
  /// Those of this process: a forked process makes its own.
  Answerers& answerers();
  void leaveForked();

  DeviceChoice choice_;
  Scene scene_;
  std::unique_ptr<Answerers> answerers_;
};

/// Messages of active validation layers since the last call, from all devices.
std::vector<std::string> takeValidationMessages();

}  // namespace radar::python
