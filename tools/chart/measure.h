// Measures one method on one workload.
#pragma once

#include <memory>

#include "baselines/baseline.h"
#include "chart/accuracy.h"
#include "chart/cases.h"

namespace radar::tools {

/// The exact answers, and how large each sensor is, in the workload's order.
struct Truth {
  std::vector<Result> results;
  std::vector<double> sizes;
};
Truth truthOf(const Workload& workload);

/// Passes over a workload after one that gives the answers and is not timed: at least `least`, and on until `budgetMs`
/// is spent; fewer, but one, where they take several budgets.
struct Timing {
  uint32_t least = 5;
  double budgetMs = 400;
};

/// A workload on which methods are measured, one after the other.
class Bench {
 public:
  /// Finds the truth. The case and the device must outlive this.
  Bench(const Case& which, const Device& device, const Timing& timing);
  ~Bench();

  const Case& which() const { return which_; }
  /// `row` is the peer's whose method it is, null for ours.
  Cell measure(const Method& method, const BaselineRow* row);

 private:
  struct Engine;

  /// Modes sampled and contact; "drawing all", which is mode sampled without select; "contact on device", whatever the
  /// batch. What one prepares serves all that take the same.
  Cell measureEngine(const Method& method);
  /// The CPU's exact search, on method.threads threads.
  Cell measureReference(const Method& method);
  /// In method.threads threads of a process of its own, each with a Baseline of its own. Where the library ends the
  /// process, Cell::failed says how.
  Cell measureBaseline(const Method& method, const BaselineRow& row);
  Cell cellOf(const Method& method) const;

  const Case& which_;
  const Device& device_;
  Timing timing_;
  Truth truth_;
  std::unique_ptr<Engine> engine_;
};

}  // namespace radar::tools
