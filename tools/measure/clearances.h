// The section of the chart that shows what clearances cost.
#pragma once

#include "measure/case.h"
#include "measure/report.h"

namespace radar::tools {

/// Section clearances, on one thread of the CPU: balls, a bull nose and a flat cutter go down on a relief; teapots fly
/// among teapots with clearances from 10^-4 times their size to their size; Table 1's sensors are asked for their
/// closest approaches and last contacts. Each query is timed alone. Adds a row to the part `clearances` for each.
void measureClearances(Extent extent, Json& report);

}  // namespace radar::tools
