// The measurements of a selftest. Each makes its first row whatever the time is, and stops at its deadline; it returns
// false if the deadline kept it from something.
#pragma once

#include "bench/clock.h"
#include "selftest/selftest.h"

namespace radar::tools {

using bench::Deadline;

bool measureArithmetic(const Device& device, const Deadline& deadline, DeviceTest& test);

/// Random queries of all families in turn, with doubles where the device has them and without, until the time is up.
/// Returns true once every family has been asked.
bool measureExactness(const Device& device, const Deadline& deadline, DeviceTest& test);

/// Batches of 1 to 10^6 small sensors among 30,000 boxes (light), of teapots (heavy), and of teapots that all move from
/// batch to batch (moving; D 15, the scene's changes in the time).
bool measureThroughput(const Device& device, const Deadline& deadline, DeviceTest& test);

/// Where the time of batches of 16,384 goes in the exact search.
bool measureStages(const Device& device, const Deadline& deadline, DeviceTest& test);

/// One batch after the other, beside two in flight.
bool measureLanes(const Device& device, const Deadline& deadline, DeviceTest& test);

/// Where the time goes in the paper's method: 256 teapots among 10,000 boxes.
bool measurePasses(const Device& device, const Deadline& deadline, DeviceTest& test);

/// Every device alone, then all of them.
bool measureTogether(const std::vector<Device>& devices, const std::vector<uint32_t>& numbers, const Deadline& deadline,
                     std::vector<LaneRow>& rows);

}  // namespace radar::tools
