// The measurements of a selftest. Each makes its first row whatever the time is, and stops at its deadline; it returns
// false if the deadline kept it from something.
#pragma once

#include "bench/clock.h"
#include "radar/radar.h"
#include "report/tables.h"

namespace radar::tools {

using bench::Deadline;

/// A device and its number in listDevices().
struct NumberedDevice {
  Device device;
  uint32_t number = 0;
};

bool measureArithmetic(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// Random queries of all families in turn, with doubles where the device has them and without, until the time is up.
/// Returns true once every family has been asked.
bool measureExactness(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// Batches of 1 to 10^6 small sensors among 30,000 boxes (light), of teapots (heavy), and of teapots that all move from
/// batch to batch (moving; D 15, the scene's changes in the time).
bool measureThroughput(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// Where the time of batches of 16,384 goes in the exact search.
bool measureStages(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// One batch after the other, beside two in flight.
bool measureLanes(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// Where the time goes in the paper's method: 256 teapots among 10,000 boxes.
bool measurePasses(const NumberedDevice& device, const Deadline& deadline, Json& rows);

/// Every device alone, then all of them.
bool measureTogether(const std::vector<Device>& devices, const std::vector<uint32_t>& numbers, const Deadline& deadline,
                     Json& rows);

}  // namespace radar::tools
