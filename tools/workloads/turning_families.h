// Cases in which sensors turn where that is known to be hard. They are for the CPU's search alone.
#pragma once

#include "workloads/hard_cases.h"

namespace radar::tools {

const std::vector<HardFamily>& turningFamilies();

}  // namespace radar::tools
