// A scene with what answers casts on it.
#pragma once

#include <sys/types.h>

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "answer/answerer.h"
#include "python/based_scene.h"

namespace radar::python {

/// Devices are opened when a batch needs them first. One thread at a time may use a CastingScene.
class CastingScene {
 public:
  explicit CastingScene(tools::AnswererOptions options);
  ~CastingScene();

  const Scene& scene() const { return based_.scene(); }
  const BasedScene& based() const { return based_; }
  /// Whether an object has a motion.
  bool moves() const;
  /// Every change is made here.
  void edit(const std::function<void(BasedScene&)>& change);
  /// This process's: a forked process makes its own.
  tools::Answerer& answerer();
  std::span<const Device> devices() const;
  unsigned threads() const { return options_.threads; }
  /// How the device was lost, if that happened since the last call.
  std::vector<std::string> takeLosses() { return std::exchange(losses_, {}); }

 private:
  void leaveForked();

  tools::AnswererOptions options_;
  std::vector<std::string> losses_;
  BasedScene based_;
  pid_t process_ = 0;
  std::unique_ptr<tools::Answerer> answerer_;
};

/// Messages of active validation layers since the last call, from all devices.
std::vector<std::string> takeValidationMessages();

}  // namespace radar::python
