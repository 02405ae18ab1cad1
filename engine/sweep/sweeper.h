// A sweep in two halves, begin() and finish(), so that two instances overlap CPU and GPU work.
#pragma once

#include "sweep/contact_runner.h"
#include "sweep/sampled_runner.h"

namespace radar {

struct Sweeper::Impl {
  /// `copy` may be shared with other instances of the same device, scene and thread; then call sync() after changes of
  /// the scene, while nothing is running on the device. `needsProof`: see ContactRunner.
  Impl(const Device::Impl& device, const Scene& scene, const SweeperOptions& options, std::shared_ptr<GpuScene> copy,
       const SearchTuning& tuning = {}, bool needsProof = true);
  /// Sweepers of this device that come later begin with what this one has learnt.
  ~Impl();

  /// Returns the error if memory does not suffice, or the device is lost: then each batch tries again, and answers as
  /// run() says.
  std::optional<Error> sync();
  /// Plans and submits a batch of valid queries, of one mode; on return the last submission may still be running.
  /// finish() completes its answers. If either throws, nothing of the batch stays with the device; one batch at a time.
  /// Of a batch that is no longer wanted, both return soon.
  void begin(Flight& flight, Mode mode);
  void finish(Flight& flight);
  /// Waits for what is running of a batch that is given up.
  void abandon(Flight& flight) noexcept;

  /// Calls `step`. If that throws, gives up the batch, and unless its stop was requested, rethrows.
  template <class Step>
  void attempt(Flight& flight, const Step& step);

  SampledRunner& sampled();
  /// Decides which side answers a batch of mode contact; later learns what it took.
  void route(Flight& flight);
  void learn(const Flight& flight);

  const gpu::Owner owner;
  const Device::Impl& device;
  const Scene& scene;
  SweeperOptions options;
  std::shared_ptr<GpuScene> copy;
  std::optional<SampledRunner> sampledRunner;  ///< made when first needed, since pipelines take time
  ContactRunner contactRunner;
  /// Null if SweeperOptions::cpuBatch decides, or the device is a CPU. May be shared with other instances of the same
  /// scene, device and thread.
  std::shared_ptr<BatchRouter> router;
};

}  // namespace radar
