// The exact answers on the processor's cores: no device, no Vulkan. For small batches, for machines without a device,
// and as the truth that everything else is tested against.
#pragma once

#include "radar/radar.h"

namespace radar {

/// What the last run() did.
struct CpuStats {
  uint64_t queries = 0;
  uint64_t nodes = 0;       ///< pairs of nodes of two meshes' trees tested
  uint64_t pairs = 0;       ///< pairs of triangles that reached the triangle test
  uint64_t exactPairs = 0;  ///< those of them that doubles could not decide
};

/// Answers batches of queries against one scene.
class RADAR_API CpuSweeper {
 public:
  /// `scene` must outlive the sweeper and stay where it is; another may be moved into its place. A batch is answered on
  /// up to `threads` threads, the caller's among them; 0: one for each core.
  explicit CpuSweeper(const Scene& scene, unsigned threads = 0);
  ~CpuSweeper();
  CpuSweeper(CpuSweeper&&) noexcept;
  CpuSweeper& operator=(CpuSweeper&&) noexcept;

  /// Brings the tree over the scene's objects up to date. run() does it too; calling it apart only moves the cost.
  void sync();

  /// Answers each query, in the order given: any number of them. `mode` and `resolution` make no difference:
  /// every answer is exact. Status is hit, clear or overlap (to a query with `decide`: hit or clear),
  /// `tier` is Tier::reference; t is t* to a few roundings, `lo` and `hi` bound it, as many apart;
  /// the pair is the least (object, triB, triA) of those that attain t*, `point` and `normal` are of that pair. There
  /// is no normal where the two triangles meet at the start already, other than by just touching, or where they lie in
  /// one plane that contains the motion; no point where they meet at the start and lie in one plane. An answer has the
  /// same bits whatever its batch and the number of threads. Throws Error if a query breaks its contract, naming it,
  /// before any is answered. A batch of one starts no thread.
  std::vector<Result> run(std::span<const Query> queries);

  const CpuStats& stats() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace radar
