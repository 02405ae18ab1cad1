// What a machine's devices are, whether they calculate and answer as they should, and how fast: a report that is
// complete whenever it is read.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/report.h"
#include "measure/timing.h"
#include "radar/radar.h"

namespace radar::tools {

/// A part of the test.
struct SelftestPart {
  const char *name, *title;
  double weight;  ///< its share of the time; what it does not use is left to the parts after it
  /// Makes the first row whatever the time is, and stops at the deadline; returns false if the deadline kept it from
  /// something. `numbers`: of the devices, in listDevices().
  bool (*measure)(std::span<const Device> devices, std::span<const uint32_t> numbers, const Deadline& deadline,
                  Json& rows);
  enum {
    each,
    eachSampled,
    together
  } asks = each;  ///< one device after the other, those that support mode sampled,
                  ///< or all at once where there are several
};
std::span<const SelftestPart> selftestParts();

/// What a device is. `number`: in listDevices().
Json factsOf(uint32_t number, const DeviceReport& report);

/// A report on the devices of these numbers in listDevices(), on all if none is given: what they are and what limits
/// them, and no part begun. A device that is not usable is in it with its reasons. Throws Error if a device does not
/// exist or is named twice, or if none is usable.
Json lookAtDevices(const std::vector<uint32_t>& numbers);

/// Runs every part on every usable device of the report, within so many minutes; `onChange` is called whenever a part
/// begins or ends.
void runSelftest(Json& report, double minutes, const std::function<void()>& onChange);

/// Sums up the parts: sets "answers_checked", "answers_wrong", "right", which is false until all parts have ended, and
/// "verdict"; and "findings": what differs from the CPU's answers, and in which of a device's stages; or if nothing
/// does, in batches of which size the CPU or the device is faster, by how much, and where that changes.
void conclude(Json& report);

}  // namespace radar::tools
