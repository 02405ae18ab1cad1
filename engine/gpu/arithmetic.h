// The checks of a device's arithmetic (radar/device.h), and the conclusions that the engine draws from them.
#pragma once

#include "gpu/device.h"
#include "shaders/arithmetic/interop.h"

namespace radar::gpu {

struct Arithmetic {
  std::vector<ArithmeticCheck> checks;
  bool floats = true;         ///< the bounds of the search hold
  bool doubles = false;       ///< sums, products and conversions follow IEEE 754, and none are fused
  bool dividesRight = false;  ///< quotients of doubles do, too; else shaders correct them
};

/// Runs the checks, those of doubles only if shaderFloat64 is enabled. `falsified`, an operation of
/// shaders/arithmetic/interop.h: the shader falsifies its results, to show that the check finds it. Submits and waits.
Arithmetic tryArithmetic(const Device::Impl& device, bool hasDoubles, uint32_t falsified = kNoOperation);

}  // namespace radar::gpu
