// The exact search for first contact on the CPU's cores.
//
// A pair of triangles is in contact during one interval [t0, t1] of distances along the motion. It contributes max(t0,
// 0) if t1 >= 0; the answer is the least over all pairs, both ends of [0, D] included. The search traverses the scene's
// trees nearest first (query_search.h, then mesh_search.h). Error bounds drop or keep what floating point can certify
// (node_test.h, leaf_test.h, certificate.h); every other decision about a pair is exact (engine/exact).
#pragma once

#include <span>
#include <vector>

#include "cpu/place_order.h"
#include "cpu/query_search.h"

namespace radar::cpu {

/// Seconds of work that justify another thread: the cost of waking it, warming it up and waiting for it. On two virtual
/// cores, two threads were as fast as one for 16 to 32 queries of 4 us.
inline constexpr double kWorthThread = 60e-6;

/// Answers queries; reuses the memory of its searches. For one thread at a time.
class Search {
 public:
  /// `tier`: of the answers. Uses up to `threads` threads (0: one per core), including the caller's; it starts none for
  /// one query, or for a few that take less time than waking a thread.
  Search(Tier tier, unsigned threads) : tier_(tier), threads_(threads) {}

  /// Writes the answers to `queries` to `results` and `lists`, of the same length; `lists` may be empty if no query has
  /// lists. The answers do not depend on the number of threads. The queries are valid, and the scene does not change
  /// meanwhile. Soon after `stop` is requested, throws Cancelled; queries without an answer then have the result that
  /// they had before.
  void run(std::span<const Query> queries, const Scene::Impl& scene, std::span<Result> results, std::span<Listed> lists,
           const std::stop_token& stop);

  unsigned threads() const { return threads_; }
  /// Pairs of triangles that all threads have tested since construction.
  uint64_t pairs() const;

 private:
  Tier tier_;
  unsigned threads_;
  std::vector<QuerySearch> searches_;  // one per thread
  PlaceOrder order_;
  double secondsPerQuery_ = 0;  // on one thread, in the last run
};

}  // namespace radar::cpu
