// One thread per device: takes chunks from the queue of batches and keeps its device busy.
#pragma once

#include <exception>
#include <memory>
#include <thread>

#include "pool/work_queue.h"
#include "sweep/sweeper.h"

namespace radar {

class Worker {
 public:
  /// Starts at once. All arguments but `options` must outlive the worker. `number`: its index in the pool.
  Worker(uint32_t number, const Device& device, const Scene& scene, const SweeperOptions& options, WorkQueue& queue);
  /// Waits until the queue lets the thread end.
  ~Worker() { thread_.join(); }

 private:
  /// Two, so that one is encoded or decoded while the device works on the other.
  static constexpr size_t kLanes = 2;
  struct Lane {
    std::unique_ptr<Sweeper::Impl> sweep;  // made on first use, since pipelines take time
    bool isMakeshift = false;              // it answers on the CPU: the device lacked memory to prove itself
    Chunk chunk;
    std::optional<Flight> flight;
    ChunkTrace trace;
    std::array<bool, 2> warm{};  // by mode: whether its pipelines have run
  };

  void run();
  bool serve();
  void begin(Lane& lane, Chunk chunk);
  void makeSweep(Lane& lane);
  void finish(Lane& lane);
  void endLanes();
  void abandon(const std::exception_ptr& exception);
  std::vector<Chunk> chunksInFlight() const;

  const uint32_t number_;
  const Device& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  WorkQueue& queue_;
  std::shared_ptr<GpuScene> copy_;  // made on first use
  std::array<Lane, kLanes> lanes_;
  size_t oldest_ = 0, inFlight_ = 0;  // a ring: `inFlight_` lanes from `oldest_` on
  uint64_t seenVersion_ = 0;
  bool isSynced_ = true;  // else memory did not suffice for the copy, and one lane at a time tries again
  double lastDone_ = 0;
  std::thread thread_;  // last, since it uses the others
};

}  // namespace radar
