// The compute passes of the contact tier, made once for a device.
#pragma once

#include <optional>

#include "gpu/kernel.h"

namespace radar {

/// How much a workgroup of the search holds: tests make it small.
struct SearchShape {
  uint32_t queue = 0;  ///< pairs that wait to be looked at, of a workgroup; 0: 8 for each lane, at least 128
  uint32_t stack = 40;
};

struct ContactKernels {
  explicit ContactKernels(const Device::Impl& device, const SearchShape& shape = {});

  uint32_t lanes;  ///< of a workgroup of the search: one subgroup
  uint32_t stack;
  gpu::Kernel search, collect, filter, link, resolve;
  std::optional<gpu::Kernel> refine;  ///< where the device has doubles
};

}  // namespace radar
