// What a call costs the host: all that its thread does but waiting for the device.
#pragma once

#include <functional>
#include <vector>

#include "measure/report.h"
#include "radar/device.h"

namespace radar::tools {

struct HostSettings {
  std::vector<uint32_t> queries{1, 256, 4'096, 65'536};  ///< in a batch
  std::vector<uint32_t> threads{1};                      ///< SweeperOptions::cpuThreads, 0: one for each core
  uint32_t repeats = 5;                                  ///< calls that count; medians
};

/// A row for each workload (Table 1's boxes among 30,000, teapots among 10,000), batch and number of threads, in
/// microseconds a query. All queries go to the device. `advance` is called after each row.
Json hostRows(const Device& device, const HostSettings& settings, const std::function<void()>& advance);
/// How many rows there will be.
size_t hostRowCount(const HostSettings& settings);

}  // namespace radar::tools
