// Accuracy against speed: every method on every case of a section, as a report with charts.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "measure/report.h"
#include "measure/try_out.h"

namespace radar::tools {

struct ChartSettings {
  Extent extent = Extent::full;
  std::vector<Case> cases;  ///< those of a section one after the other
  std::function<std::vector<Method>(const std::string& section)> methods;
};

/// Adds to a report the table `cases`, and a table of cells for each section, which is written after each case. `step`
/// is called before each cell.
void measureCases(const ChartSettings& settings, Json& report, const std::filesystem::path& folder,
                  const std::function<void()>& step);

Json rowOf(const Cell& cell);
/// The cells of a report's sections, and beside those of Table 1 the paper's own times. Throws as nlohmann::json does
/// if it has others.
std::vector<Cell> cellsOf(const Json& report);

/// The cells of a workload that have numbers, each method once: in the number of threads in which it was fastest.
/// Those of one method are beside each other, in the order of the cells.
std::vector<const Cell*> shownCells(std::span<const Cell> cells, const std::string& workload);

/// The methods that no other method beats in both speed and accuracy, by rising time. Fewer wrong answers are better;
/// of equal shares, a lesser worst error, down to 1e-13 sizes of the sensor.
std::vector<const Cell*> frontOf(std::span<const Cell* const> cells);

/// Sums the sections up in tables, draws a chart of each workload that has cells if `draws`, and writes all.
///
/// `workloads`: microseconds per query of our methods, and the fastest other library without a wrong answer;
/// `methods`: accuracy and times over all workloads of section front; `growth`: each method's microseconds per query at
/// both ends of an axis.
void sumUp(Json& report, const std::filesystem::path& folder, bool draws = true);

}  // namespace radar::tools
