// A ScaleReport for people and programs.
#pragma once

#include <string>

#include "scale/measure.h"

namespace radar::tools {

/// A line for each run, then the times of the stages.
std::string tableOf(const ScaleReport& report);
/// One line for each run and device of it. Times in milliseconds of a pass over all batches.
std::string csvOf(const ScaleReport& report);
/// The last point's runs in Chrome's trace-event format: a process for each set of devices.
std::string traceOf(const ScaleReport& report);

}  // namespace radar::tools
