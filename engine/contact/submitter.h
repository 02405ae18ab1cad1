// The contact tier on a queue of the engine's: one batch at a time.
#pragma once

#include "contact/decode.h"
#include "contact/pass.h"
#include "gpu/submission.h"

namespace radar {

/// What the device says of a batch: valid until the next submit().
struct SearchAnswers {
  std::span<const Result> results;  ///< one a sensor
  std::span<const gpu::UnresolvedPair> unresolved;
  bool roomier = false;  ///< the next batch has more room for candidates, of which this one had too little
  uint64_t nodePairs = 0, trianglePairs = 0, solves = 0;
};

class ContactSubmitter {
 public:
  ContactSubmitter(const Device::Impl& device, GpuScene& scene, bool timestamps,
                   std::shared_ptr<const ContactKernels> kernels, const SearchRoom& room);

  /// Hands the batch to the device, and returns while that works on it; collect() comes next.
  void submit(SensorBatch& batch, const Scene::Impl& scene);
  /// Waits; submits more only where the search takes longer than a submission has rounds. A result that is
  /// Status::invalid says in its flags what the device had no room or range for.
  SearchAnswers collect(const Scene::Impl& scene, std::vector<StageTime>& stages);
  uint32_t submissions() const { return submissions_; }  ///< of the last batch

 private:
  void recordAndSubmit();
  const gpu::SearchCounts& counts() const;

  GpuScene& scene_;
  gpu::Submission submission_;
  ContactPass pass_;
  gpu::Buffer readback_;  ///< counts, then results
  uint32_t submissions_ = 0;
};

}  // namespace radar
