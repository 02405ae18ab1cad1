// A sweep in two halves, begin() and finish(), so that two instances overlap CPU and GPU work.
#pragma once

#include "sweep/contact_tier.h"
#include "sweep/sampled_tier.h"

namespace radar {

struct Sweeper::Impl : QueryBatch {
  /// `copy` may be shared with other instances of the same device, scene and thread; then call sync() after changes of
  /// the scene, while nothing is running on the device. `kernels`: null: the device's.
  Impl(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, std::shared_ptr<GpuScene> copy,
       const SearchRoom& room = {}, std::shared_ptr<const ContactKernels> kernels = nullptr);

  /// Returns the error if memory does not suffice: then each batch tries again, and answers as run() says.
  std::optional<Error> sync();
  /// Encodes and submits valid `queries`; on return the last submission may still be running. `queries` must stay in
  /// place until finish(); call that next. Then `answers` are complete, for the caller to take.
  void begin(std::span<const Query> queries, Mode mode);
  void finish();

  void validateAll(std::span<const Query> queries, Mode mode) const;
  SampledTier& sampled();
  void runSampled();

  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  std::shared_ptr<GpuScene> copy;
  std::optional<SampledTier> sampledTier;  ///< made when first needed, since pipelines take time
  ContactTier contactTier;
};

}  // namespace radar
