// Computes chunk sizes: guided self-scheduling, weighted by speed. Independent of devices and clocks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace radar {

class ChunkScheduler {
 public:
  explicit ChunkScheduler(size_t workers) : workers_(workers) {}

  /// `worker` has finished `queries` in `ms`.
  void finished(size_t worker, size_t queries, double ms);
  /// A batch was done without the worker, which seemed too slow. Raises its estimated speed, so that it is tried again
  /// eventually.
  void passed(size_t worker);
  /// The worker takes no more.
  void retire(size_t worker) { workers_[worker].alive = false; }
  size_t alive() const;

  /// How many queries `worker` should take now; 0: none, since others will finish sooner. `batch`: queries left in its
  /// batch, at least 1; `all`: in all batches; `inFlight`: queries it is working on.
  size_t take(size_t worker, size_t batch, size_t all, size_t inFlight) const;

 private:
  struct Worker {
    double rate = 0;  // queries per ms; 0: unknown
    bool alive = true;
  };
  double rateOf(size_t worker) const;

  std::vector<Worker> workers_;
};

}  // namespace radar
