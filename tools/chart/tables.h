// The same tables for the page and for the docs: a heading line, then a line for each cell.
#pragma once

#include <string>
#include <vector>

#include "chart/record.h"

namespace radar::tools {

using Table = std::vector<std::vector<std::string>>;

/// Errors, misses, brackets and tiers of a workload's methods.
Table accuracyTable(const Record& record, const std::string& workload);
/// Times of a workload's methods, with every number of threads.
Table speedTable(const Record& record, const std::string& workload);
/// Times over the boxes of Table 1, with the paper's rows last.
Table table1Table(const Record& record);
/// Times over a growing axis: boxes, sensors or triangles.
Table growthTable(const Record& record, const std::string& axis);

/// Three digits, or whole; a dash where there is no number.
std::string inWords(double value);

}  // namespace radar::tools
