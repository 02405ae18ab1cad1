// What answers would take with a GPU that was measured on another machine, beside the host's part as it is measured
// here.
#pragma once

#include <cstdint>
#include <span>

#include "measure/report.h"

namespace radar::tools {

/// What a device was measured to take: docs/performance.md#on-a-gpu, in docs/figures.json.
struct MeasuredDevice {
  const char* workload;  ///< as hostRows() names it
  uint32_t batch;
  double us;  ///< of a query, from upload to readback
};
inline constexpr const char* kMeasuredDevice = "NVIDIA H200, driver 580.159.04, commit f8fe4dd, 26 November 2026";
std::span<const MeasuredDevice> measuredDevices();

inline constexpr uint32_t kModelThreads = 16;

/// A row for each of them; microseconds a query. `hostRows`: of hostRows(), one thread, with batches of 1. Each takes
/// the host's part from the largest batch there that is not larger. Throws Error if there is none.
///
/// host = serial_us + parallel_us / threads. parallel_us: what check, submit and decode take, without record_us: what
/// they take in a batch of 1, once a call. serial_us: the rest of the calling thread's part, record_us included. The
/// device works while the host does, so a query takes the greater of both; at least, once there are several submissions
/// in flight. Without that, it takes the sum.
Json modelRows(const Json& hostRows);
/// That in words, for whoever reads the table.
std::string modelAssumptions();

}  // namespace radar::tools
