// Measures one method on one workload.
#pragma once

#include "chart/accuracy.h"
#include "chart/cases.h"
#include "peers/peer.h"

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

/// Modes sampled, bounded and contact, and "drawing all", which is mode sampled without select.
Cell measureEngine(const Case& which, const Method& method, const Truth& truth, const Device& device,
                   const Timing& timing);
/// In method.threads threads, each with a Reference of its own.
Cell measureReference(const Case& which, const Method& method, const Truth& truth, const Timing& timing);
/// In method.threads threads of a process of its own, each with a Peer of its own. Where the library ends the process,
/// Cell::failed says how.
Cell measurePeer(const Case& which, const Method& method, const PeerRow& row, const Truth& truth, const Timing& timing);

}  // namespace radar::tools
