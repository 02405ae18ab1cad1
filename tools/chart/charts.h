// What a run shows: charts of accuracy against speed and of growing work, and the tables that sum them up.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "chart/record.h"
#include "report/tables.h"

namespace radar::tools {

/// The cells of a workload that have numbers, each method once: in the number of threads in which it was fastest.
/// Those of one method are beside each other, in the order of the record.
std::vector<const Cell*> shownCells(const Record& record, const std::string& section, const std::string& workload);

/// The methods that no other method beats in both speed and accuracy, by rising time. Fewer wrong answers are better;
/// of equal shares, a lesser worst error, down to 1e-13 sizes of the sensor.
std::vector<const Cell*> frontOf(std::span<const Cell* const> cells);

/// A row for each method, over all workloads of section front.
Json methodTable(const Record& record);
/// A row for each workload of section front: microseconds per query of our methods, and the fastest other library
/// without a wrong answer.
Json workloadTable(const Record& record);
/// Sections table1 and growth: each method's microseconds per query at both ends of the axis; the paper's own beside.
Json growthTable(const Record& record);

/// Writes the tables as methods.csv, workloads.csv and growth.csv; points.csv, from which the scripts of tools/plot
/// draw; and each chart as an SVG file. Throws as plot() does.
void writeCharts(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
