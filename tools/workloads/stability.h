// Where collision queries are known to fail: families of small cases, each over the range of one parameter. Equal
// arguments give equal bits on every platform.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "workloads/stability_cases.h"
#include "workloads/workload.h"

namespace radar::tools {

struct StabilityFamily {
  std::string name;
  std::string parameter;       ///< what the values say, with their unit
  std::vector<double> values;  ///< taken in turn by the cases
  StabilityCase (*make)(double value, Random& random);
  bool placesItself = false;  ///< else cases are turned and moved at random, half of them by exact steps
};

const std::vector<StabilityFamily>& stabilityFamilies();

/// Case `number` of a family and a seed: the same whatever else is asked. Sensor and scene change places in half of the
/// cases that have one object.
StabilityCase stabilityCase(const StabilityFamily& family, uint64_t number, uint64_t seed);

/// Each case takes one bit of the masks, so that it meets its own objects only.
inline constexpr uint32_t kCasesPerScene = 32;

/// Cases as one scene with one batch; at most kCasesPerScene.
Workload workloadOf(const std::vector<StabilityCase>& cases);

}  // namespace radar::tools
