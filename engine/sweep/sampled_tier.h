// Mode sampled: plans slices of a batch on the CPU and submits them in as few submissions as fit. One submission runs
// at a time, and is decoded before the next is staged.
#pragma once

#include "sampled/submitter.h"
#include "sweep/query_batch.h"

namespace radar {

class SampledTier {
 public:
  SampledTier(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, GpuScene& resident,
              QueryBatch& batch);

  /// Plans and submits the batch; on return the last submission may still be running.
  void run();
  /// Waits for the last submission and decodes it.
  void collect();
  /// The pictures from which a valid query is answered. No submission may be running.
  Scopes scopes(const Query& query);

 private:
  /// A planned query of a slice.
  struct Planned {
    size_t query;
    ViewPlan plan;
  };
  /// The size of a submission.
  struct Load {
    uint64_t views = 0, draws = 0, items = 0;
    uint32_t resolution = 0;
    void add(const ViewPlan& plan);
  };

  bool fits(const Load& load) const;
  std::string reasonAgainst(const ViewPlan& plan) const;
  ViewPlan planOf(const Query& query, Drawn drawn) const;
  void flush(std::vector<Planned>& slice);
  /// Submits a part, in halves if the device's memory does not suffice.
  void submit(std::span<Planned> part);
  /// Returns false, and submits nothing, if memory does not suffice; if `isLast`, the part's queries fail instead.
  bool trySubmit(std::span<Planned> part, bool isLast);

  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  QueryBatch& batch_;
  SampledSubmitter submitter_;
  uint64_t bufferBytes_;
  uint64_t maxItems_;       ///< so that item and lane fit 32 bits (gpu::Candidate)
  PendingQueries pending_;  ///< in the order of `drawn_.views`
  SampledBatch drawn_;
};

}  // namespace radar
