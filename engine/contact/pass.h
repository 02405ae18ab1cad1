// Records the contact tier into any command buffer: rounds of the search, then the answers. Owns its buffers.
#pragma once

#include <functional>
#include <span>

#include "contact/pair_solver.h"
#include "contact/search_plan.h"
#include "contact/tuning.h"

namespace radar {

class ContactPass {
 public:
  ContactPass(const gpu::Owner& owner, GpuScene& scene, const SearchTuning& tuning);

  /// Makes room for this many searches and known answers; stage() then allocates nothing for batches up to this size,
  /// but for changes of the scene.
  void reserve(uint32_t searches, uint32_t results, uint32_t excluded);
  /// Makes room for the batch, and stages it with the changes of the scene. `known`: answers that need no search; if
  /// given, they include placeholders for those of the batch. `next`: see GpuScene::stage. The device is idle.
  GpuScene::Staged stage(const SearchSource& batch, std::span<const Result> known, const Scene::Impl& scene,
                         GpuScene::Overwritten next = {});
  /// The same for `searches` that a shader states after the upload. None has a clearance or ignores what does not
  /// block.
  GpuScene::Staged stageWritten(uint32_t searches, const Scene::Impl& scene, GpuScene::Overwritten next = {});
  /// What that shader writes: one of each per search, but for excluded objects, for which there is that much room.
  struct Stated {
    const gpu::Array<gpu::StatedSearch>& searches;
    const gpu::Array<gpu::Sweep>& sweeps;
    const gpu::Array<uint32_t>& excluded;
  };
  Stated stated() const { return {stated_, solver_.lists().sweeps, excluded_}; }

  /// Every program that a pass may run on the device.
  static std::vector<gpu::Program> programs(const Device::Impl& device);

  /// Records the copies and the barrier after them.
  void recordUpload(const gpu::Commands& commands, const OpenStage& stage);
  /// Records the encoding of what is stated, once the scene on the device is as the search is to find it.
  void recordEncoding(const gpu::Commands& commands, const OpenStage& stage);
  /// Records the search in `rounds` rounds, an even number up to kMostRounds, then the answers, which are none if
  /// searches are unfinished. `isLast`: those are abandoned. The caller records the barrier between the answers and
  /// their readers.
  void record(const gpu::Commands& commands, const OpenStage& stage, uint32_t rounds, bool isLast);
  /// Stages the continuation of the search, once the device has finished and left `counts`.
  void stageMore(const gpu::SearchCounts& counts);
  /// Iterations of a workgroup in each round recorded from now on.
  void setBudget(uint32_t iterations) { tuning_.budget = iterations; }
  /// Tasks left over by the rounds recorded last.
  uint32_t tasksLeft(const gpu::SearchCounts& counts) const { return counts.rounds[rounds_].tasks; }

  /// As encoded.
  const gpu::Array<gpu::Sensor>& sensors() const { return sensors_; }
  const gpu::Array<gpu::SearchState>& states() const { return solver_.lists().states; }
  const gpu::Array<gpu::SearchTask>& tasks() const { return tasks_; }
  const gpu::Array<Result>& results() const { return solver_.lists().results; }
  const gpu::Array<gpu::SearchCounts>& counts() const { return solver_.lists().counts; }
  /// See PairSolver.
  std::span<const gpu::UnresolvedPair> unresolved(const gpu::SearchCounts& counts) const {
    return solver_.unresolved(counts);
  }
  uint32_t searchCount() const { return searchCount_; }
  /// SearchCounts::serial of what was staged last.
  uint32_t serial() const { return solver_.serial(); }
  /// Enlarges lists that were too small, for the next batch. Returns whether the list of candidates was.
  bool learn(const gpu::SearchCounts& counts);

 private:
  GpuScene::Staged beginStaging(uint32_t searches, const Scene::Impl& scene, GpuScene::Overwritten next);
  void recordRound(const gpu::Commands& commands, uint32_t round, bool isLast);
  void reserveLists(uint32_t searches, uint32_t results);

  const Device::Impl* device_;
  GpuScene& scene_;
  SearchTuning tuning_;  ///< from tunedFor(), with a budget
  gpu::Program search_, searchWithClearance_;
  gpu::Passes run_;
  gpu::Upload upload_;
  gpu::Array<gpu::StatedSearch> stated_;
  gpu::Array<gpu::Sensor> sensors_;
  gpu::Array<uint32_t> excluded_;
  gpu::Array<gpu::SearchTask> tasks_, spilled_;
  gpu::Array<gpu::QueuedPair> queues_;
  gpu::Array<gpu::CandidatePair> candidates_;
  PairSolver solver_;
  gpu::EncodePush encoding_{};
  uint32_t taskRoom_ = 0, candidateRoom_ = 0;
  bool ignoresLeaving_ = false, hasClearances_ = false;
  uint32_t searchCount_ = 0, rounds_ = 0, wantedCandidates_ = 0, wantedUnresolved_ = 0;
};

}  // namespace radar
