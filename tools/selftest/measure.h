// The measurements of a selftest.
#pragma once

#include <span>

#include "measure/timing.h"
#include "radar/radar.h"
#include "measure/report.h"

namespace radar::tools {

/// A part of the test of a device.
struct SelftestPart {
  const char* name;
  double weight;  ///< share of the device's time; 0: as much as all the others leave
  /// Makes the first row whatever the time is, and stops at the deadline; returns false if the deadline kept it from
  /// something. `number`: of the device, in listDevices().
  bool (*measure)(const Device& device, uint32_t number, const Deadline& deadline, Json& rows);
  bool sampled = false;  ///< only on devices that support mode sampled
};
std::span<const SelftestPart> selftestParts();

/// Every device alone, then all of them; as SelftestPart::measure.
bool measureTogether(const std::vector<Device>& devices, const std::vector<uint32_t>& numbers, const Deadline& deadline,
                     Json& rows);

}  // namespace radar::tools
