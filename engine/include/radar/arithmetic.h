// How a device calculates: the operations on which the bounds of mode contact rest, tried with numbers whose results
// the CPU knows. Vulkan leaves drivers some freedom (its specification, "Precision and Operation of SPIR-V
// Instructions"), and this is what they make of it.
#pragma once

#include "radar/radar.h"

namespace radar {

/// One operation. Device::open() and Device::adopt() make the same checks and heed what follows from them.
struct ArithmeticCheck {
  std::string operation;
  uint32_t tried = 0;       ///< results looked at
  uint32_t wrong = 0;       ///< of these, results that are not as needed
  double worst = 0;         ///< error of the worst result, in units in the last place; NaN: not measured
  std::string found;        ///< what the device does, in words
  std::string needed;       ///< what the engine relies on; empty: nothing, this is told for information
  std::string consequence;  ///< what follows, as it was found
  bool passed() const { return wrong == 0; }
};

/// Makes all checks on `device`: those of doubles only if its feature shaderFloat64 is enabled. Submits to the device's
/// queue and waits. Throws Error where it has no queue, or a submission fails.
RADAR_API std::vector<ArithmeticCheck> checkArithmetic(const Device& device);

}  // namespace radar
