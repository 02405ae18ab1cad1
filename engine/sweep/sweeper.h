// A sweep in two halves: whoever has two of these encodes one batch while the device works on the other.
#pragma once

#include "sweep/contact_tier.h"
#include "sweep/sampled_tier.h"

namespace radar {

struct Sweeper::Impl : Asked {
  /// `copy` may be shared with others of the same device and scene, used by the same thread; a scene that changed is
  /// then brought there by sync(), while nothing is with the device. `kernels`: null: the device's.
  Impl(const Device& device, const Scene& scene, const SweeperOptions& options, std::shared_ptr<GpuScene> copy,
       const SearchRoom& room = {}, std::shared_ptr<const ContactKernels> kernels = nullptr);

  void sync();
  /// Encodes `queries`, which keep their contracts, and submits them; on return the last submission is still with the
  /// device. `queries` and `results`, one for each, stay where they are until finish(), which comes next.
  void begin(std::span<const Query> queries, std::span<Result> results);
  void finish();

  void refuseWrong(std::span<const Query> queries) const;
  SampledTier& sampled();
  void runSampled(std::span<const size_t> which);

  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  std::shared_ptr<GpuScene> copy;
  std::optional<SampledTier> sampledTier;  ///< made when first needed: pipelines take a while
  ContactTier contactTier;
};

}  // namespace radar
