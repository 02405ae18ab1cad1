// A whole run: every method on every workload, each cell on disk as soon as it is measured.
#pragma once

#include <filesystem>
#include <functional>

#include "chart/measure.h"
#include "chart/record.h"

namespace radar::tools {

struct RunSettings {
  Extent extent = Extent::full;
  std::vector<Case> cases;
  uint32_t threads = 1;  ///< of the processor: the most that a method takes
};

/// One cell to be measured.
struct Planned {
  const Case* which = nullptr;
  Method method;
  const BaselineRow* row = nullptr;  ///< of a baseline
};

/// Every cell of the run, in the order of the file. `rows` and `settings` must outlive the plan.
std::vector<Planned> planOf(const RunSettings& settings, const std::vector<BaselineRow>& rows);

/// Measures the plan and writes `record`, which comes without cells, after each cell. Where `folder` holds a record of
/// the same `run`, goes on after its cells. `step` is called before each cell.
Record measureAll(const RunSettings& settings, const std::vector<Planned>& plan, Record record, const Device& device,
                  const std::filesystem::path& folder, const std::function<void()>& step);

/// For the record's `run`: of this very program, the settings, and `origin`, which stands for all else.
std::string fingerprintOf(const RunSettings& settings, const std::string& origin);

}  // namespace radar::tools
