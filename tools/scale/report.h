// A ScaleReport for people and programs.
#pragma once

#include <string>

#include "scale/measure.h"

namespace radar::tools {

/// What a report says of where it comes from.
struct ScaleOrigin {
  std::string command, commit, date, scene, mode;
};

std::string tableOf(const ScaleReport& report);
/// One line for each run and device of it. Times in milliseconds of a pass over all batches.
std::string csvOf(const ScaleReport& report);
/// One page with all it needs: the paper's Figure 7, speed-up and efficiency, timelines, tables, findings.
std::string htmlOf(const ScaleReport& report, const ScaleOrigin& origin);
/// The last point's runs in Chrome's trace-event format: a process for each set of devices.
std::string traceOf(const ScaleReport& report);

}  // namespace radar::tools
