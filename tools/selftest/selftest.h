// What a machine's devices are, whether they calculate and answer as they should, and how fast. The report is a JSON
// document that is complete whenever it is read:
//
//   {"verdict", "command", "commit", "date", "processor", "minutes", "seconds", "right", "devices": [...], "together":
//   part} device: {"number", "name", ..., "answers_checked", "answers_wrong", "parts_ended", "right", "limits": table,
//            "parts": {name: part}}
//   part: {"state", "note", "seconds", "rows": table}
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "radar/radar.h"
#include "measure/report.h"

namespace radar::tools {

/// What a device is: the values of the report above from "number" to "limits". `number`: in listDevices().
Json factsOf(uint32_t number, const DeviceReport& report);

/// A report on the devices of these numbers in listDevices(), on all if none is given: what they are, and no part
/// begun. A device that is not usable is in it with its reasons. Throws Error if a device does not exist or is named
/// twice, or if none is usable.
Json lookAtDevices(const std::vector<uint32_t>& numbers);

/// Runs every part on every usable device of the report, within so many minutes; `onChange` is called whenever a part
/// begins or ends.
void runSelftest(Json& report, double minutes, const std::function<void()>& onChange);

/// Sums up the parts: sets "answers_checked", "answers_wrong", "parts_ended", "right", which is false until all parts
/// have ended, and "verdict": right or not, whether the CPU or which device is faster, by how much, and what to set.
void conclude(Json& report);

/// The report's verdict, and a few lines on each device; and all of it, which begins so.
std::string selftestSummary(const Json& report);
std::string selftestText(const Json& report);

/// The files of a report, by name: text, JSON, tables as CSV, and a page with charts that loads nothing else.
std::map<std::string, std::string> selftestFiles(const Json& report);

}  // namespace radar::tools
