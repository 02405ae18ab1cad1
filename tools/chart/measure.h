// Measures one method on one workload.
#pragma once

#include <memory>

#include "baselines/baseline.h"
#include "bench/harness.h"
#include "chart/cases.h"
#include "chart/record.h"
#include "stability/judge.h"

namespace radar::tools {

/// Fills the accuracy columns of a cell whose `certified` is set. `truth` is the reference's, `sizes` the sensors'.
void judge(Cell& cell, std::span<const Claim> claims, std::span<const Result> truth, std::span<const double> sizes);

/// A workload on which methods are measured, one after the other.
class Bench {
 public:
  /// Finds the exact answers. The case and the device must outlive this. A method that takes several times
  /// `repetition.seconds` makes fewer passes than it should, but one.
  Bench(const Case& which, const Device& device, const bench::Repetition& repetition);
  ~Bench();

  const Case& which() const { return which_; }
  /// `row` is the baseline's whose method it is, null for ours.
  Cell measure(const Method& method, const BaselineRow* row);

 private:
  struct Engine;
  /// Modes sampled and contact; "drawing all", which is mode sampled without select; "contact on device", whatever the
  /// batch. What one prepares serves all that take the same.
  std::vector<Result> sweep(Cell& cell);

  const Case& which_;
  const Device& device_;
  bench::Repetition repetition_;
  std::vector<Result> truth_;
  std::vector<double> sizes_;  ///< of the sensors
  std::unique_ptr<Engine> engine_;
};

}  // namespace radar::tools
