// The exact search on the CPU's cores, without Vulkan: for small batches, for machines without a device, and as the
// reference for tests.
#pragma once

#include <memory>
#include <span>
#include <stop_token>

#include "radar/answers.h"
#include "radar/query.h"

namespace radar {

/// Answers batches of queries against one scene.
class RADAR_API CpuSweeper {
 public:
  /// `scene` must outlive the sweeper at the same address; another scene may be moved into it. A batch runs on up to
  /// `threads` threads, including the caller's; 0: one per core.
  explicit CpuSweeper(const Scene& scene, unsigned threads = 0);
  ~CpuSweeper();
  CpuSweeper(CpuSweeper&&) noexcept;
  CpuSweeper& operator=(CpuSweeper&&) noexcept;

  /// Updates the tree over the scene's objects. run() does this too; a separate call only moves the cost.
  void sync();

  /// Answers any number of queries exactly, with Tier::reference. Without a clearance, t is t* to a few roundings,
  /// which also separate `lo` and `hi`, its bounds, and the pair is the least (object, triB, triA) of those that attain
  /// t*. An answer's bits do not depend on its batch or on the number of threads. Throws Error, naming the query, if
  /// one breaks its contract, before any is answered. A batch of one uses no other thread. `stop`: as of Sweeper::run.
  Answers run(std::span<const Query> queries, const std::stop_token& stop = {});
  /// As Sweeper::run, too.
  void run(std::span<const Query> queries, Answers& answers, const std::stop_token& stop = {});

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
