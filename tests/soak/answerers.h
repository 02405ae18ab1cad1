// Everything that answers queries about one scene, for as long as an epoch lasts.
#pragma once

#include <optional>

#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "radar/recorder.h"
#include "soak/batch.h"
#include "soak/fault_plan.h"
#include "soak/world.h"

namespace radar::soak {

class Answerers {
 public:
  /// `pooled`: the devices of the pool, which nothing else uses.
  Answerers(const Device& device, std::span<const Device> pooled, World& world, tools::Random& random, Tally& tally);

  /// Edits the scene and lets everything answer a batch. Throws std::logic_error, naming who, if an answer is wrong.
  void round();

 private:
  Batch batchOf(std::vector<Query> queries, Mode mode = Mode::contact);
  Batch choose();
  /// Holds the CPU's answers against brute force, and against those about a scene made anew.
  void checkExact(const Batch& batch);
  template <class Remake>
  void askSweeper(Who who, std::optional<Sweeper>& sweeper, const Batch& batch, const Remake& remake);
  template <class Make>
  void askRecorder(Who who, std::optional<Recorder>& recorder, Capacity& capacity, const Batch& batch,
                   const Make& make);
  void askPool(const Batch& batch);
  void cancel(const Batch& batch);
  void share();

  const Device* device_;
  std::span<const Device> pooled_;
  World* world_;
  tools::Random* random_;
  Tally* tally_;
  SweeperOptions options_;
  CpuSweeper cpu_;
  std::optional<Sweeper> sweeper_;
  std::optional<SceneCopy> copy_;
  std::optional<Sweeper> sharing_;
  Capacity ownRoom_, sharedRoom_;
  std::optional<Recorder> recorder_, sharedRecorder_;
  std::optional<Pool> pool_;
};

}  // namespace radar::soak
