// The exact search for first contact on the processor's cores.
//
// Contact of a pair of triangles happens for one interval [t0, t1] of distances along the motion; the pair contributes
// max(t0, 0) if t1 >= 0, and the answer is the least over all pairs, both ends of [0, D] included. The scene's trees
// are searched nearest first (query_search.h, then mesh_search.h). What floating point is certain of is dropped or kept
// by error bounds (node_test.h, leaf_test.h, certificate.h); every other decision about a pair is exact (engine/exact).
#pragma once

#include <span>
#include <vector>

#include "cpu/query_search.h"

namespace radar::cpu {

/// Answers queries, and keeps the memory of its searches from one call to the next. One thread at a time.
class Search {
 public:
  /// Puts the answers to `queries`, with `tier` in each, into `results`, of the same number; on up to `threads` threads
  /// (0: one for each core), the caller's among them. One query starts none, nor do a few that take less time than
  /// starting a thread does. The answers do not depend on the number of threads. The queries hold their contract, and
  /// the scene does not change meanwhile.
  void run(std::span<const Query> queries, const Scene::Impl& scene, Tier tier, unsigned threads,
           std::span<Result> results);

  /// Since construction, of all threads.
  SearchStats stats() const;

 private:
  std::vector<QuerySearch> searches_;  // one for each thread
  double secondsPerQuery_ = 0;         // of one thread, in the last run
};

}  // namespace radar::cpu
