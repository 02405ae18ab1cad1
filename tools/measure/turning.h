// The section of the chart that shows what motions cost that turn.
#pragma once

#include "baselines/baseline.h"
#include "measure/case.h"
#include "measure/report.h"

namespace radar::tools {

using MakeRigidBodies = std::unique_ptr<RigidBodies>(const Workload&);

/// Section turns, on one thread of the CPU: sensors among boxes that move straight, and that turn by 30 degrees on the
/// same ways; and an arm's motions. Some of these are also asked of FCL, if it is there: turns by its continuous mode,
/// free motions by advancement, from the links' distances to the cell, and both at 64 steps. Adds a row to the part
/// `turns` for each; "times_the_first" of FCL's is that of ours to the same queries.
void measureTurns(Extent extent, MakeRigidBodies* makeBodies, Json& report);

}  // namespace radar::tools
