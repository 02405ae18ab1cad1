// A whole run: every method on every workload, each cell on disk as soon as it is measured.
#pragma once

#include <filesystem>
#include <functional>

#include "chart/record.h"

namespace radar::tools {

struct RunSettings {
  Extent extent = Extent::full;
  std::vector<Case> cases;
  std::function<std::vector<Method>(const std::string& section)> methods;
};

/// Measures all and writes `record`, which comes without cells, after each cell. `step` is called before each cell.
Record measureAll(const RunSettings& settings, Record record, const std::filesystem::path& folder,
                  const std::function<void()>& step);

}  // namespace radar::tools
