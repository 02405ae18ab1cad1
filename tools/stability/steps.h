// Stability in the plain sense: a sensor's pose moves in tiny steps, and no answer may jump further than the geometry.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "stability/case_run.h"

namespace radar::tools {

struct StepRow {
  std::string family;
  Method method = Method::contact;
  uint64_t steps = 0;  ///< from pose to pose, where the reference finds contact in both
  uint64_t flips = 0;  ///< steps in which only one of the two contacts is found
  /// The most that t moved in a step beyond what the reference's did, in units of max(size of the sensor, t*).
  double excess = 0;
};

struct StepSettings {
  uint32_t cases = 32;  ///< of each family
  uint32_t steps = 16;  ///< of each case, in one direction
  double size = 1e-6;   ///< of a step, of the sensor's size
  uint64_t seed = 1;
  uint32_t resolution = 64;  ///< of all modes but contact
};

/// `onProgress` receives the number of cases just done.
std::vector<StepRow> measureSteps(const Device& device, const StepSettings& settings,
                                  const std::function<void(uint64_t)>& onProgress);

}  // namespace radar::tools
