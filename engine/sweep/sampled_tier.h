// Mode sampled: slices of a batch, planned on the CPU, in as few submissions as fit. One of them is with the device at
// a time; it lands before the next is staged.
#pragma once

#include "sampled/submitter.h"
#include "sweep/asked.h"

namespace radar {

class SampledTier {
 public:
  SampledTier(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, GpuScene& resident,
              Asked& batch);

  /// Plans these queries and submits them; on return the last submission may still be with the device.
  void run(std::span<const size_t> which);
  /// Waits for it and decodes it.
  void land();
  /// The pictures behind the answer to a query, which keeps its contract. Nothing is with the device.
  Scopes scopes(const Query& query);

 private:
  /// One query of a slice on its way to the device.
  struct Pending {
    size_t query;
    ViewPlan plan;
  };
  /// What one submission has to hold.
  struct Load {
    uint64_t views = 0, draws = 0, items = 0;
    uint32_t resolution = 0;
    void add(const ViewPlan& plan);
  };

  bool fits(const Load& load) const;
  std::string reasonAgainst(const ViewPlan& plan) const;
  ViewPlan planOf(const Query& query, Drawn drawn) const;
  void flush(std::vector<Pending>& slice);
  void submit(std::span<Pending> part);

  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  Asked& batch_;
  SampledSubmitter recorder_;
  uint64_t bufferBytes_;
  uint64_t maxItems_;           ///< items name triangles in 32 bits
  std::vector<size_t> flying_;  ///< the queries with the device, in the order of `drawn_.views`
  SampledBatch drawn_;
};

}  // namespace radar
