// The exact answer on one CPU thread: what every tier is measured against, and the line to beat in every chart.
//
// For every pair of a sensor triangle and an object triangle, contact happens for one interval [t0, t1] of distances
// along the motion; the pair contributes max(t0, 0) if t1 >= 0, and the answer is the least over all pairs, both ends
// of [0, D] included. Two trees are searched nearest first (objects, then the two meshes' triangles), pruned by the
// best so far; every decision about a pair is exact (radar/exact).
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "radar/radar.h"

namespace radar::reference {

/// Follows the scene: what was added, moved or removed is noticed at the next call. One thread at a time.
class Reference {
 public:
  /// `scene` must outlive the reference and stay where it is.
  explicit Reference(const Scene& scene);
  ~Reference();

  /// Status is hit, clear or overlap. `lo` and `hi` are t rounded outwards; the pair is the least (object, triB, triA)
  /// of those that attain t*; `point` and `normal` are of that pair. There is no normal where the two triangles
  /// meet at the start already, other than by just touching, or where they lie in one plane that contains the motion;
  /// no point where they meet at the start and lie in one plane. Throws if the query breaks its contract.
  Result answer(const Query& query);
  std::vector<Result> run(std::span<const Query> queries);

  /// Builds the trees a query would need, so that the first one is not slower. run() does it too.
  void sync();

  /// Pairs of triangles that reached a box test, since construction.
  uint64_t pairs() const;
  /// Those of them that doubles could not decide.
  uint64_t exactPairs() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar::reference
