// The device's answers held against those of the CPU's exact search.
#pragma once

#include <vector>

#include "measure/judge.h"
#include "workloads/workload.h"

namespace radar::test {

struct Compared {
  tools::Tally tally;
  std::vector<double> excessInPixels;  ///< hi - t* of each contact that mode sampled found

  uint64_t found() const { return tally.contacts() - tally.unseen; }
};

/// Asks the device for all queries in one batch, and CHECKs every promise of every answer.
Compared compare(const Scene& scene, const std::vector<Query>& queries, Mode mode = Mode::contact);
/// Likewise every batch of the workload: in mode sampled with so many pixels, or in mode contact.
Compared compare(const tools::Workload& workload, uint32_t resolution = 0);

}  // namespace radar::test
