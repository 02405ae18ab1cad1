// A sweep in two halves, begin() and finish(), so that two instances overlap CPU and GPU work.
#pragma once

#include "sweep/contact_tier.h"
#include "sweep/sampled_tier.h"

namespace radar {

struct Sweeper::Impl : QueryBatch {
  /// `copy` may be shared with other instances of the same device, scene and thread; then call sync() after changes of
  /// the scene, while nothing is running on the device. `needsProof`: see ContactTier.
  Impl(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, std::shared_ptr<GpuScene> copy,
       const SearchRoom& room = {}, bool needsProof = true);

  /// Returns the error if memory does not suffice: then each batch tries again, and answers as run() says.
  std::optional<Error> sync();
  /// Encodes and submits valid `queries`; on return the last submission may still be running. `queries` and `results`,
  /// of the same length, must stay in place until finish(); call that next.
  void begin(std::span<const Query> queries, std::span<Result> results);
  void finish();

  void validateAll(std::span<const Query> queries) const;
  SampledTier& sampled();
  void runSampled(std::span<const size_t> which);

  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  std::shared_ptr<GpuScene> copy;
  std::optional<SampledTier> sampledTier;  ///< made when first needed, since pipelines take time
  ContactTier contactTier;
  Lists joinedLists;  ///< of the last run()
};

}  // namespace radar
