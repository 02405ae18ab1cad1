// Modes sampled, bounded and contact held against the reference, answer by answer.
#pragma once

#include <cstdint>
#include <vector>

#include "reference/reference.h"
#include "workloads/workload.h"

namespace radar::test {

struct Tally {
  uint32_t queries = 0, contacts = 0, found = 0, clear = 0;
  std::vector<double> excessInPixels;  ///< hi - t* of each contact that was found
};

/// Answers every query of the workload both ways and CHECKs every promise that a single sampled answer makes.
Tally compareWithReference(const tools::Workload& workload, uint32_t resolution);

struct BoundedTally {
  uint32_t queries = 0, contacts = 0, found = 0, clear = 0, undecided = 0;
  std::vector<double> widthInPixels;  ///< hi - lo of each contact that was found
  double decided() const { return 1 - double(undecided) / queries; }
  void add(const BoundedTally& more);
};

/// Answers the queries in mode bounded, in one batch, and CHECKs every promise that the brackets make. `resolution`: 0
/// for refining.
BoundedTally compareBounded(const Scene& scene, std::vector<Query> queries, uint32_t resolution);
BoundedTally compareBounded(const Scene& scene, Sweeper& sweeper, reference::Reference& reference,
                            std::vector<Query> queries, uint32_t resolution);
/// Likewise every batch of the workload.
BoundedTally compareBounded(const tools::Workload& workload, uint32_t resolution);

struct ContactTally {
  uint32_t queries = 0, hits = 0, overlaps = 0, clear = 0;
};

/// Answers the queries in mode contact, in one batch, and by the reference, and CHECKs that they agree in every
/// promise.
/// Their brackets in mode bounded are checked besides.
ContactTally compareContact(const Scene& scene, std::vector<Query> queries);
/// Likewise every batch of the workload.
ContactTally compareContact(const tools::Workload& workload);

}  // namespace radar::test
