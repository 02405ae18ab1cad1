// Answers queries with what the engine offers.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "workloads/workload.h"

namespace radar::tools {

struct AnswererOptions {
  uint32_t device = kNone;  ///< kNone: the best
  /// These devices share the work, instead of `device`; empty: all that are usable.
  std::optional<std::vector<uint32_t>> pool;
  bool timestamps = false;                               ///< measure each stage
  uint32_t cpuBatch = kNone;                             ///< SweeperOptions::cpuBatch
  uint32_t threads = 0;                                  ///< of the CPU's exact search; 0: one for each core
  std::function<void(const std::string&)> onValidation;  ///< messages of active validation layers
  OnCompiling onCompiling;
  std::function<void(const std::string&)> onLost;  ///< called once, with how the device was lost
};

/// One thread at a time may use an Answerer.
class Answerer {
 public:
  /// The scene must outlive this.
  Answerer(const Scene& scene, AnswererOptions options) : scene_(scene), options_(std::move(options)) {}

  /// Every change of the scene is made here, since a pool must know of it.
  void edit(const std::function<void()>& change);
  /// Opens what the mode needs, unless it is open. Throws Error if no device is usable.
  void open(AnswerMode mode);
  /// Brings the scene to where it is needed, as far as that is open.
  void sync();
  /// Opens what the mode needs, and throws and stops as Sweeper::run and Pool::submit do.
  Answers run(const std::vector<Query>& queries, AnswerMode mode, const std::stop_token& stop = {});
  /// In the memory that `answers` has.
  void run(const std::vector<Query>& queries, Answers& answers, AnswerMode mode, const std::stop_token& stop = {});

  /// Those that are open: none where the CPU has answered everything.
  std::span<const Device> devices() const { return devices_; }
  /// Empty without a pool.
  std::vector<PoolDevice> poolDevices() const { return pool_ ? pool_->devices() : std::vector<PoolDevice>(); }

 private:
  const Scene& scene_;
  AnswererOptions options_;
  std::vector<Device> devices_;
  std::optional<Sweeper> sweeper_;
  std::optional<Pool> pool_;
  std::optional<CpuSweeper> cpu_;
};

}  // namespace radar::tools
