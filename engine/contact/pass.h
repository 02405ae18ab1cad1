// The recipe of the contact tier, into any command buffer: rounds of the search, then the answers. Owns its buffers.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>

#include "contact/kernels.h"
#include "contact/sensors.h"
#include "scene/gpu_scene.h"

namespace radar {

/// Room for a search's lists, and how it is cut into dispatches. Zeros: chosen for the device and the batch.
struct SearchRoom {
  uint32_t tasks = 0;       ///< beside one for each sensor
  uint32_t candidates = 0;  ///< of all sensors
  uint32_t unresolved = 0;  ///< pairs left to the host; a sensor's are listed together or not at all
  uint32_t groups = 0;      ///< workgroups of a round
  uint32_t budget = 0;      ///< iterations of a workgroup in a round
  uint32_t width = 0;       ///< fewer tasks than this are split soon
};

class ContactPass {
 public:
  ContactPass(const Device::Impl& device, GpuScene& scene, std::shared_ptr<const ContactKernels> kernels,
              const SearchRoom& room);

  /// Makes room for so many sensors and, beside them, known answers; stage() of no more allocates nothing.
  void reserve(uint32_t sensors, uint32_t results, uint32_t excluded);
  /// Makes room for the batch, and stages it with what changed in the scene. `known`: answers that need no search;
  /// where they are, those of the batch are placeholders. The device is idle.
  void stage(SensorBatch& batch, std::span<const Result> known, const Scene::Impl& scene);

  using OpenStage = std::function<void(const char*)>;
  /// The copies, and the barrier behind them.
  void recordUpload(const gpu::Commands& commands, const OpenStage& stage);
  /// The search, in so many rounds, an even number up to kMostRounds; then the answers. `isLast`: what is not finished
  /// by then is given up. The caller puts the barrier between the answers and what reads them.
  void record(const gpu::Commands& commands, const OpenStage& stage, uint32_t rounds, bool isLast);
  /// Once the device is done, and `counts` is what it left: stages what it takes to go on.
  void stageMore(const gpu::SearchCounts& counts);
  /// Tasks that the rounds recorded last have left.
  uint32_t tasksLeft(const gpu::SearchCounts& counts) const { return counts.rounds[rounds_].tasks; }

  const gpu::Array<Result>& results() const { return results_; }
  const gpu::Array<gpu::SearchCounts>& counts() const { return counts_; }
  /// On the host: the pairs that were left to it. Valid until the device works again.
  std::span<const gpu::UnresolvedPair> unresolved(const gpu::SearchCounts& counts) const;
  uint32_t sensorCount() const { return sensorCount_; }
  /// Where a list had too little room, there will be more the next time. Returns whether that is so for candidates.
  bool learn(const gpu::SearchCounts& counts);

  /// Iterations that no device ends silently or takes for a hang.
  static constexpr uint32_t kMostBudget = 30'000;

 private:
  void setArguments();
  void reserveLists(uint32_t sensors);
  uint32_t groupsFor(uint32_t sensors) const;

  const Device::Impl* device_;
  GpuScene& scene_;
  std::shared_ptr<const ContactKernels> kernels_;
  SearchRoom room_;
  gpu::Upload upload_;
  gpu::TexelArray<gpu::Sensor> sensors_;
  gpu::Array<gpu::Sweep> sweeps_;
  gpu::Array<gpu::SearchState> states_;
  gpu::Array<uint32_t> heads_, excluded_;
  gpu::Array<gpu::SearchTask> tasks_, spilled_;
  gpu::Array<gpu::PairCandidate> candidates_;
  gpu::Array<gpu::Contender> contenders_;
  gpu::Array<gpu::SearchCounts> counts_;
  gpu::Array<Result> results_;
  gpu::Array<gpu::UnresolvedPair> unresolved_;  ///< on the host: hardly ever is there any
  // Rounds go back and forth between the two lists of tasks.
  gpu::KernelArguments search_[2], collect_[2], filter_, link_, resolve_;
  std::optional<gpu::KernelArguments> refine_;
  std::vector<gpu::SearchState> stateList_;
  std::vector<gpu::SearchTask> taskList_;
  uint32_t taskRoom_ = 0, candidateRoom_ = 0, unresolvedRoom_ = 0;
  uint32_t sensorCount_ = 0, rounds_ = 0, wantedCandidates_ = 0, wantedUnresolved_ = 0;
  VkDeviceSize reservedBytes_ = 0;
};

}  // namespace radar
