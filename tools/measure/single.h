// The section of the chart that shows what one query takes when it is asked alone, and what threads gain.
#pragma once

#include "measure/method.h"
#include "measure/report.h"

namespace radar::tools {

using Ask = std::function<void(const Query&)>;
/// Seconds of each query, asked alone, by each way of asking: the least of three passes after one that does not count,
/// since the machine has more to do. The ways take turns.
std::vector<std::vector<double>> secondsAlone(std::span<const Query> queries, std::span<const Ask> ways);
/// The columns `queries`, and in microseconds `mean`, `median`, `99_percent` and `slowest`.
Json latencies(std::span<const double> seconds);

/// Section single, on the CPU, among Table 1's 30,000 boxes. A row of the part `single` for each shape of sensor and
/// each way to cast it, one by one: by a CpuSweeper, and by the `libraries` that cast a convex shape; "wrong" counts
/// their contacts that are none, and those they miss. A row of the part `threads` for each size of a batch and each
/// number of threads up to the processor's: of nine passes the least time, and processor time of all threads;
/// "efficiency" is the time on one thread over that on all, together.
void measureSingle(Extent extent, std::span<const BaselineRow> libraries, Json& report);

}  // namespace radar::tools
