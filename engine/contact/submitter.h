// Runs the contact tier on the engine's queue, one batch at a time.
#pragma once

#include "contact/decode.h"
#include "contact/pass.h"
#include "gpu/submission.h"

namespace radar {

/// The device's answers to a batch; valid until the next submit().
struct SearchAnswers {
  std::span<const Result> results;  ///< one per sensor
  std::span<const gpu::UnresolvedPair> unresolved;
  bool roomier = false;        ///< this batch had too little room for candidates; the next one has more
  uint64_t trianglePairs = 0;  ///< tested
};

class ContactSubmitter {
 public:
  ContactSubmitter(const Device::Impl& device, GpuScene& scene, bool timestamps, const SearchRoom& room);

  /// Submits the batch and returns without waiting; call collect() next.
  void submit(SensorBatch& batch, const Scene::Impl& scene);
  /// Waits, and submits more rounds until the search is complete. The flags of an invalid result tell what the device
  /// had no room or range for.
  SearchAnswers collect(std::vector<StageTime>& stages);
  uint32_t submissions() const { return submissions_; }  ///< made for the last batch

 private:
  void recordAndSubmit();
  const gpu::SearchCounts& counts() const;

  GpuScene& scene_;
  gpu::Submission submission_;
  ContactPass pass_;
  gpu::Buffer readback_;  ///< counts, then results
  GpuScene::Staged staged_;
  uint32_t submissions_ = 0;
};

}  // namespace radar
