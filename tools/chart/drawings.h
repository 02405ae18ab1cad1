// The charts of a run.
#pragma once

#include "chart/record.h"
#include "report/chart.h"

namespace radar::tools {

struct Drawing {
  std::string name;     ///< of its file
  std::string caption;  ///< what it shows, in one line
  std::vector<std::string> notes;
  Chart chart;
};

/// Time against worst error on one workload, misses in a band of their own, the front drawn.
Drawing frontDrawing(const Record& record, const WorkloadNote& workload);
/// Time against the number of boxes, with the paper's own times. Needs section table1.
Drawing table1Drawing(const Record& record);
/// Time against boxes, sensors, triangles and resolution: those that were measured.
std::vector<Drawing> growthDrawings(const Record& record);

std::vector<Drawing> drawingsOf(const Record& record);

}  // namespace radar::tools
