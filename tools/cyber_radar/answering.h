// Answers workloads with the engine.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch/answer_file.h"
#include "batch/query_file.h"
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

/// What answering took.
struct AnsweringStats {
  double ms = 0;                       ///< from handing over the queries to having the answers, scene changes included
  uint64_t batches = 0;                ///< calls of the engine's
  uint64_t pairs = 0;                  ///< pairs of triangles or leaves that were looked at, or were proposed by pixels
  uint64_t cpuPairs = 0;               ///< those of them decided on the CPU
  std::array<uint64_t, 5> statuses{};  ///< answers of each Status
  uint32_t leastResolution = kNone, mostResolution = 0;  ///< of the pictures; 0 if none was drawn
  std::vector<StageTime> stages;
};

class Answering {
 public:
  /// Opens a device if one is needed; throws radar::Error if none is usable. `world` has the meshes and scenes; it
  /// must outlive this.
  /// Throws InputError if mode sampled is chosen for a query that asks for what it does not offer.
  Answering(const Workload& world, const ModesAsked& asked, const AnsweringOptions& options);

  /// Shows a scene and brings it to where it is needed. Returns milliseconds.
  double setUp(uint32_t scene);

  /// Answers queries, batch by batch, and adds to stats().
  std::vector<Answer> run(std::span<const QuerySpec> queries, Progress& progress);
  /// Since the last reset.
  const AnsweringStats& stats() const { return stats_; }
  void resetStats() { stats_ = {}; }

  /// Those opened: none where the CPU answers everything.
  std::span<const Device> devices() const { return devices_; }
  /// Empty without a pool.
  std::vector<PoolDevice> poolDevices() const { return pool_ ? pool_->devices() : std::vector<PoolDevice>(); }

 private:
  struct Part {
    std::vector<uint32_t> numbers;  ///< among those asked together
    std::vector<Query> queries;
  };
  struct Group {
    uint32_t scene = 0;
    std::array<Part, 3> parts;  ///< by AnswerMode
  };
  void show(uint32_t scene);
  Answers answer(const std::vector<Query>& queries, AnswerMode mode);

  std::vector<Group> groupsOf(std::span<const QuerySpec> queries) const;

  AnsweringOptions options_;
  AnsweringStats stats_;
  ScenePlayer player_;
  std::vector<Device> devices_;
  std::optional<Sweeper> sweeper_;
  std::optional<Pool> pool_;
  std::optional<CpuSweeper> cpu_;
};

/// Sets up and answers all queries of a workload.
std::vector<Answer> answersTo(const Workload& workload, Answering& answering, const std::string& label);

/// Whether some query was not answered.
bool someInvalid(std::span<const Answer> answers);

}  // namespace radar::tools
