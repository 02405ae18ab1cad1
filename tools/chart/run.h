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
  const BaselineRow* row = nullptr;  ///< of a peer
  std::string key;
};

/// Every cell of the run, in the order of the file. `rows` and `settings` must outlive the plan. `origin` stands for
/// all that a cell depends on besides: the program and the device.
std::vector<Planned> planOf(const RunSettings& settings, const std::vector<BaselineRow>& rows,
                            const std::string& origin);

/// Measures what `folder` does not hold already and writes `record`, which comes without cells, after each cell.
/// `step` is called before each cell.
Record measureAll(const RunSettings& settings, const std::vector<Planned>& plan, Record record, const Device& device,
                  const std::filesystem::path& folder, const std::function<void(const Planned&)>& step);

/// A fingerprint of this very program, so that an interrupted run is told from one of another.
std::string programFingerprint();

}  // namespace radar::tools
