// Modes sampled and contact held against the CPU's exact search, answer by answer.
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

struct ContactTally {
  uint32_t queries = 0, hits = 0, overlaps = 0, clear = 0;
};

/// Answers the queries in mode contact, in one batch, and on the CPU, and CHECKs that they agree in every
/// promise.
ContactTally compareContact(const Scene& scene, std::vector<Query> queries);
/// Likewise every batch of the workload.
ContactTally compareContact(const tools::Workload& workload);

}  // namespace radar::test
