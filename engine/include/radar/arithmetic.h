// Checks of a device: its arithmetic, that is, the operations on which the bounds of mode contact rest, on numbers
// whose results the CPU knows; and its answers to queries that the CPU has answered. Vulkan leaves drivers some freedom
// (its specification, "Precision and Operation of SPIR-V Instructions").
#pragma once

#include "radar/device.h"

namespace radar {

/// The check of one operation. Device::open() and Device::adopt() run the same checks and act on the results.
struct ArithmeticCheck {
  std::string operation;
  uint32_t tried = 0;   ///< results compared
  uint32_t wrong = 0;   ///< results that are not as needed
  double worst = 0;     ///< error of the worst result, in units in the last place; NaN: not measured
  std::string needed;   ///< what the engine relies on
  std::string ifWrong;  ///< what it does if a result is wrong
  bool passed() const { return wrong == 0; }
};

/// Runs all checks on `device`, those of doubles only if shaderFloat64 is enabled. Submits to the device's queue and
/// waits. Throws Error if there is no queue, or a submission fails.
RADAR_API std::vector<ArithmeticCheck> checkArithmetic(const Device& device);

/// Answers of one kind, compared with the CPU's.
struct AnswerCheck {
  std::string kind;
  uint32_t asked = 0;
  uint32_t wrong = 0;      ///< answers that differ in any bit; of mode sampled, brackets without the exact distance
  std::string firstWrong;  ///< what was answered, and what was expected
  bool passed() const { return wrong == 0; }
};

/// Asks queries of every kind, recorded ones and geometry in a host's buffers included, about a small scene that `seed`
/// decides. Submits to the device's queue and waits. Throws Error if there is no queue, or a submission fails.
///
/// Seeds 0 and 1 are how a device proves itself: the first Sweeper that searches on it, and the first Recorder, ask
/// them when they are made, but for clearances and mode sampled, and throw with the reasons if an answer is wrong. A
/// Recorder of a device without a queue cannot: then call this on a Device with a queue of the same driver, once.
RADAR_API std::vector<AnswerCheck> checkAnswers(const Device& device, uint64_t seed = 0);

}  // namespace radar
