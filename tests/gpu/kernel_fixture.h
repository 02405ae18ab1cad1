// The tests' kernels, shared per device like the engine's, and a function that runs them.
#pragma once

#include <functional>

#include "gpu/barrier.h"
#include "gpu/kernel.h"
#include "gpu/kernel_interop.h"
#include "gpu/submission.h"
#include "support/test_device.h"

namespace radar::test {

struct Kernels {
  explicit Kernels(const Device::Impl& device);
  gpu::Kernel scale;         ///< 64 lanes
  gpu::Kernel scaleAndAdd5;  ///< one lane, offset 5
  gpu::Kernel fillNodes, sumTexels, countGroups, readDepth;
};

inline const Device::Impl& impl() {
  return device().impl();
}
inline const Kernels& kernels() {
  return impl().shared<Kernels>();
}

/// Submits what `record` records, and waits; the host may then read what compute shaders wrote.
void run(const std::function<void(const gpu::Commands&)>& record);

/// The first `count` of the numbers 0, 1, 2, ... in memory that the host can access.
gpu::Array<uint32_t> numbers(const char* name, uint32_t count);

}  // namespace radar::test
