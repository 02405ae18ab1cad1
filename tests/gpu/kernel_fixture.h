// The tests' shaders, and a function that runs them.
#pragma once

#include <functional>

#include "gpu/barrier.h"
#include "gpu/kernel.h"
#include "gpu/kernel_interop.h"
#include "gpu/submission.h"
#include "spirv/gpu_test_shaders.h"
#include "support/test_device.h"

namespace radar::test {

inline constexpr gpu::Program kScaleOf64{kScale, {64}};       ///< 64 lanes
inline constexpr gpu::Program kScaleAndAdd5{kScale, {1, 5}};  ///< one lane, offset 5

inline const Device::Impl& impl() {
  return device().impl();
}

/// Submits what `record` records, and waits; the host may then read what compute shaders wrote.
void run(const std::function<void(const gpu::Commands&)>& record);

/// The first `count` of the numbers 0, 1, 2, ... in memory that the host can access.
gpu::Array<uint32_t> numbers(const char* name, uint32_t count);

}  // namespace radar::test
