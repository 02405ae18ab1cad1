// A ScaleReport as tables and as a timeline.
#pragma once

#include <string>

#include "measure/report.h"
#include "scale/measure.h"

namespace radar::tools {

/// A row for each run: what was gained, and where the devices' time (their number times the time that passed) went, in
/// percent of it that add up to 100: `useful`, at work for as long as each device takes alone for as many queries;
/// `slower`, at work for longer than that; `start`, `gap` and `tail`, idle as in DeviceShare; `scene`, idle while the
/// scene is edited. `encode` is the time encoding over the time with the device.
Json runTable(const ScaleReport& report);
/// A row for each run and device of it. Times in milliseconds of a pass over all batches.
Json shareTable(const ScaleReport& report);
/// The last point's stages, milliseconds of a pass with timestamps, summed over devices.
Json stageTable(const ScaleReport& report);
/// The last point's runs in Chrome's trace-event format: a process for each set of devices.
std::string traceOf(const ScaleReport& report);

}  // namespace radar::tools
