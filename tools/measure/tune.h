// Which numbers the search is fastest with on a device (engine/contact/tuning.h).
#pragma once

#include <functional>

#include "measure/report.h"
#include "radar/device.h"

namespace radar::tools {

struct TuneSettings {
  double share = 1;      ///< of the usual numbers of queries: less for a slow device
  uint32_t repeats = 3;  ///< searches that count, of each setting and workload; medians
};

/// Tries each number with several values, the others as usual, then together those that are faster. Adds the part
/// "tune": a row for each, with the device's time over the usual one by workload, and their geometric mean; the last
/// row is the combination. Throws Error if an answer depends on a number. `advance` is called after each row.
void tune(const Device& device, const TuneSettings& settings, Json& report, const std::function<void()>& advance);
size_t tuneSteps(const Device& device);

}  // namespace radar::tools
