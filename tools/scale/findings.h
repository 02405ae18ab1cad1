// Where the time of several devices goes, and what limits them, in words derived from the numbers.
#pragma once

#include "scale/measure.h"

namespace radar::tools {

/// Parts of a set's device time (its devices times the time that passed); they add up to 1.
struct Losses {
  double useful = 0;                    ///< at work, as long as each device alone takes for as many queries
  double slower = 0;                    ///< at work for longer than that; negative where a device was faster
  double start = 0, gap = 0, tail = 0;  ///< idle, as in DeviceShare
  double scene = 0;                     ///< idle while the scene is edited
};
Losses lossesOf(const ScaleReport& report, const ScaleRun& run);

/// Time encoding over time with the device.
double encodingShare(const ScaleRun& run);

/// One sentence each: what was gained, then what limits it, the greatest first. Of the last point and all devices.
std::vector<std::string> findingsOf(const ScaleReport& report);

}  // namespace radar::tools
