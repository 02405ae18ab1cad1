// The compute kernels of the contact tier, created once per device.
#pragma once

#include <array>
#include <mutex>
#include <optional>

#include "gpu/kernel.h"

namespace radar {

/// Capacities of a workgroup of the search; tests make them small.
struct SearchShape {
  uint32_t queue = 0;  ///< waiting pairs per workgroup; 0: 8 per lane, at least 128
  uint32_t stack = 40;
};

struct ContactKernels {
  explicit ContactKernels(const Device::Impl& device, const SearchShape& shape = {});

  uint32_t lanes;  ///< per workgroup of the search, which is one subgroup
  uint32_t stack;
  gpu::Kernel search, collect, filter, link, resolve;
  std::optional<gpu::Kernel> refine, refineLeaving, block;  ///< if the device has doubles

  /// The search for queries with a clearance, created at the first call; any thread may call.
  const gpu::Kernel& searchWithClearance() const;

 private:
  const Device::Impl& device_;
  std::array<uint32_t, 4> constants_;
  mutable std::once_flag clearanceOnce_;
  mutable std::optional<gpu::Kernel> clearance_;
};

}  // namespace radar
