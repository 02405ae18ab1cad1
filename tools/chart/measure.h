// Measures one method on one workload.
#pragma once

#include <memory>

#include "baselines/baseline.h"
#include "bench/harness.h"
#include "chart/cases.h"
#include "chart/cell.h"

namespace radar::tools {

/// Passes over a workload after one that is not timed: at least `least`, and on until `seconds` are over; fewer, but
/// one, where they take several times as long.
struct Timing {
  uint32_t least = 5;
  double seconds = 0.4;
};

/// A workload on which methods are measured, one after the other.
class Bench {
 public:
  /// Finds the exact answers. The case and the device must outlive this.
  Bench(const Case& which, const Device& device, const Timing& timing);
  ~Bench();

  const Case& which() const { return which_; }
  /// `row` is the peer's whose method it is, null for ours.
  Cell measure(const Method& method, const BaselineRow* row);

 private:
  struct Engine;

  std::vector<bench::Batch> batchesFor(Mode mode, uint32_t resolution) const;
  /// Fills the columns of time; returns the answers in the order of the batches.
  std::vector<Result> timePasses(Cell& cell, const bench::Method& method, std::span<const bench::Batch> batches) const;
  /// Modes sampled and contact; "drawing all", which is mode sampled without select; "contact on device", whatever the
  /// batch. What one prepares serves all that take the same.
  std::vector<Result> sweep(Cell& cell);
  /// The CPU's exact search, on cell.threads threads.
  std::vector<Result> searchOnCpu(Cell& cell) const;
  /// In cell.threads threads, each with a Baseline of its own.
  std::vector<Result> cast(Cell& cell, const BaselineRow& row) const;
  /// The same in a process of its own. Where the library ends it, Cell::failed says how.
  std::vector<Result> castInChild(Cell& cell, const BaselineRow& row) const;

  const Case& which_;
  const Device& device_;
  Timing timing_;
  std::vector<Result> truth_;
  std::vector<double> sizes_;  ///< of the sensors
  std::unique_ptr<Engine> engine_;
};

}  // namespace radar::tools
