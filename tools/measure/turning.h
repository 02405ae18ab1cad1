// The section of the chart that shows what motions cost that turn.
#pragma once

#include "baselines/baseline.h"
#include "measure/case.h"
#include "measure/report.h"

namespace radar::tools {

using MakeDistances = std::unique_ptr<Distances>(const Workload&);

/// Section turns, on one thread of the CPU: sensors among boxes that move straight, and that turn by 30 degrees on the
/// same ways; and an arm's motions, of which the free ones are also asked of FCL, if it is there: by advancement, from
/// the links' distances to the cell. Adds a row to the part `turns` for each.
void measureTurns(Extent extent, MakeDistances* makeDistances, Json& report);

}  // namespace radar::tools
