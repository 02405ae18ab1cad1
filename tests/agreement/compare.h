// Mode sampled held against the reference, answer by answer.
#pragma once

#include <cstdint>
#include <vector>

#include "workloads/workload.h"

namespace radar::test {

struct Tally {
  uint32_t queries = 0, contacts = 0, found = 0, clear = 0;
  std::vector<double> excessInPixels;  ///< hi - t* of each contact that was found
};

/// Answers every query of the workload both ways and CHECKs every promise that a single sampled answer makes.
Tally compareWithReference(const tools::Workload& workload, uint32_t resolution);

}  // namespace radar::test
