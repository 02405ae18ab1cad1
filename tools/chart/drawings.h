// The charts of a run: what each shows, and its rows of points.csv, from which the scripts of tools/plot draw it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "chart/record.h"

namespace radar::tools {

struct Drawing {
  std::string name;    ///< of its file, without .svg, and of its rows
  std::string title;   ///< a colon begins a second line
  std::string xLabel;  ///< empty: accuracy against speed on one workload, the front marked
  std::string rows;    ///< of points.csv
};

/// Section front: a chart for each workload on which something was measured. Then the paper's Table 1, and the growth
/// with boxes, sensors, triangles and resolution.
std::vector<Drawing> drawingsOf(const Record& record);

/// Writes points.csv and each chart as an SVG file. Throws as plot() does.
void writeCharts(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
