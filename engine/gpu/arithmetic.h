// What of a device's arithmetic can be relied on: all checks of radar/arithmetic.h, and what follows for the engine.
#pragma once

#include "gpu/device.h"
#include "radar/arithmetic.h"
#include "shaders/interop.h"

namespace radar::gpu {

struct Arithmetic {
  std::vector<ArithmeticCheck> checks;
  bool floats = true;         ///< the bounds of the search hold
  bool doubles = false;       ///< sums, products and conversions are those of IEEE 754, and none is fused with another
  bool dividesRight = false;  ///< quotients of doubles, too; else shaders correct them
};

/// Tries what is there: doubles only if the feature shaderFloat64 is enabled. `spoiled`, a k... of shaders/interop.h:
/// an operation whose results the shader falsifies, to show that this would be found. Submits and waits.
Arithmetic tryArithmetic(const Device::Impl& device, bool hasDoubles, uint32_t spoiled = kNoOperation);

}  // namespace radar::gpu
