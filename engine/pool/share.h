// How much a device takes at a time: guided self-scheduling, weighted by speed. Knows no device and no clock.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace radar {

class Share {
 public:
  explicit Share(size_t workers) : workers_(workers) {}

  /// `worker` took `ms` for `queries`, of which it is now rid.
  void finished(size_t worker, size_t queries, double ms);
  /// A batch went by without it, since it was thought too slow. That may no longer be true, and it will be tried again.
  void passed(size_t worker);
  /// It takes no more.
  void retire(size_t worker) { workers_[worker].alive = false; }
  size_t alive() const;

  /// How many queries `worker` should take now; 0: better none, others will be done sooner. `batch`: what is left of
  /// the batch that it would take from, at least 1; `all`: of all batches; `inFlight`: queries it is working on.
  size_t take(size_t worker, size_t batch, size_t all, size_t inFlight) const;

 private:
  struct Worker {
    double rate = 0;  // queries per ms; 0: not known
    bool alive = true;
  };
  double rateOf(size_t worker) const;

  std::vector<Worker> workers_;
};

}  // namespace radar
