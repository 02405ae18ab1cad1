// Checks of a device's arithmetic: the operations on which the bounds of mode contact rest, run on numbers whose
// results the CPU knows. Vulkan leaves drivers some freedom (its specification, "Precision and Operation of SPIR-V
// Instructions").
#pragma once

#include "radar/device.h"

namespace radar {

/// The check of one operation. Device::open() and Device::adopt() run the same checks and act on the results.
struct ArithmeticCheck {
  std::string operation;
  uint32_t tried = 0;       ///< results compared
  uint32_t wrong = 0;       ///< results that are not as needed
  double worst = 0;         ///< error of the worst result, in units in the last place; NaN: not measured
  std::string found;        ///< what the device does
  std::string needed;       ///< what the engine relies on; empty: nothing, the check is informative
  std::string consequence;  ///< consequence of the result
  bool passed() const { return wrong == 0; }
};

/// Runs all checks on `device`, those of doubles only if shaderFloat64 is enabled. Submits to the device's queue and
/// waits. Throws Error if there is no queue, or a submission fails.
RADAR_API std::vector<ArithmeticCheck> checkArithmetic(const Device& device);

}  // namespace radar
