// Charts for pages that are made where gnuplot may be missing: lines over logarithmic axes, as inline SVG.
#pragma once

#include <string>

#include "report/chart.h"

namespace radar::tools {

/// For a page of page.h: title, axes, lines with their names at their ends, tips. Values are above 0. What else a Chart
/// can hold is not drawn: `about`, floors, misses, fronts.
std::string plainSvg(const Chart& chart);

}  // namespace radar::tools
