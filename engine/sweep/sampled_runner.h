// Mode sampled: plans slices of a batch on the CPU's threads and submits them in as few submissions as fit. One
// submission runs at a time, and is decoded before the next is staged.
#pragma once

#include "sampled/submitter.h"
#include "sweep/flight.h"

namespace radar {

class SampledRunner {
 public:
  SampledRunner(const gpu::Owner& owner, const Scene& scene, const SweeperOptions& options, GpuScene& resident);

  /// Plans and submits the batch; on return the last submission may still be running. Throws Cancelled soon after the
  /// batch's stop is requested; then call abandon().
  void begin(Flight& flight);
  /// Waits for the last submission, if one is running, and decodes it.
  void finish(Flight& flight);
  /// Waits for what is running of a batch that is given up.
  void abandon(Flight& flight) noexcept;
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

  bool fitsBuffers(const Load& load) const;
  bool fits(const Load& load) const;
  std::string reasonAgainst(const ViewPlan& plan) const;
  ViewPlan planOf(const Query& query, Drawn drawn) const;
  /// Plans of at least one query, and of as many from `first` on as a submission can hold, so that memory stays bounded
  /// however many there are. On all threads.
  std::vector<ViewPlan> planFrom(const Flight& flight, size_t first) const;
  void flush(Flight& flight, std::vector<Planned>& slice);
  /// Submits a part, in halves if the device's memory does not suffice.
  void submit(Flight& flight, std::span<Planned> part);
  /// Returns false, and submits nothing, if memory does not suffice; if `isLast`, the part's queries fail instead.
  bool trySubmit(Flight& flight, std::span<Planned> part, bool isLast);

  const Device::Impl& device_;
  const Scene& scene_;
  const SweeperOptions options_;
  const uint32_t passTriangles_;
  SampledSubmitter submitter_;
  uint64_t bufferBytes_;
  uint64_t maxItems_;   ///< so that item and lane fit 32 bits (gpu::Candidate)
  SampledBatch drawn_;  ///< the last submission
};

}  // namespace radar
