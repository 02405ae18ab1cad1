// Answers workloads with the engine.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/answer_file.h"
#include "cyber_radar/progress.h"
#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "workloads/workload.h"

namespace radar::tools {

struct AnsweringOptions {
  AnswerMode mode = AnswerMode::contact;  ///< of queries that do not choose one
  uint32_t resolution = 0;                ///< 0: chosen per sensor
  uint32_t device = kNone;                ///< kNone: the best
  /// These devices share the work, instead of `device`; empty: all that are usable.
  std::optional<std::vector<uint32_t>> pool;
  bool timestamps = false;    ///< measure each stage
  uint32_t cpuBatch = kNone;  ///< SweeperOptions::cpuBatch
  uint32_t threads = 0;       ///< of the CPU's exact search; 0: one for each core
};

class Answering {
 public:
  /// Opens a device if a query needs one; throws radar::Error if none is usable. The workload must outlive this.
  Answering(const Workload& workload, const AnsweringOptions& options);

  /// Shows the scene of the first batch and brings it to where it is needed. Returns milliseconds.
  double setUp();

  struct Pass {
    std::vector<Answer> answers;  ///< in the workload's order
    double ms = 0;                ///< from handing over the queries to having the answers, scene changes included
    uint64_t pairs = 0;           ///< pairs of triangles or leaves that were looked at, or were proposed by pixels
    uint64_t cpuPairs = 0;        ///< those of them decided on the CPU
    std::vector<StageTime> stages;
  };
  /// Answers everything, batch by batch. setUp() comes before each pass.
  Pass run(const std::string& label);

  size_t batchCount() const { return groups_.size(); }
  /// Those opened: none where the CPU answers everything.
  std::span<const Device> devices() const { return devices_; }
  /// Empty without a pool.
  std::vector<PoolDevice> poolDevices() const { return pool_ ? pool_->devices() : std::vector<PoolDevice>(); }

 private:
  struct Part {
    std::vector<uint32_t> numbers;  ///< in the workload
    std::vector<AnswerMode> modes;
    std::vector<Query> queries;
  };
  struct Group {
    uint32_t scene = 0;
    Part swept, onCpu;
  };
  void show(uint32_t scene);
  PoolAnswers sweep(const std::vector<Query>& queries);
  PoolAnswers answerOnCpu(const std::vector<Query>& queries);

  const Workload& workload_;
  std::vector<Group> groups_;
  ScenePlayer player_;
  std::vector<Device> devices_;
  std::optional<Sweeper> sweeper_;
  std::optional<Pool> pool_;
  std::optional<CpuSweeper> cpu_;
};

/// The lines of an answer file.
std::string answerLines(const Workload& workload, const std::vector<Answer>& answers);
/// The exit status of a command that gives these answers.
int exitStatusOf(const std::vector<Answer>& answers);

}  // namespace radar::tools
