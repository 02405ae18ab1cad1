// A whole run: every method on every workload, each cell on disk as soon as it is measured.
#pragma once

#include <functional>
#include <span>

#include "baselines/baseline.h"
#include "chart/cases.h"
#include "chart/record.h"
#include "stability/judge.h"

namespace radar::tools {

struct RunSettings {
  Extent extent = Extent::full;
  std::vector<Case> cases;
  std::vector<BaselineRow> baselines;
  uint32_t threads = 1;  ///< of the processor: the most that a method takes
};

struct ChartMethod {
  std::string family;    ///< sampled, contact, reference, "drawing all" (sampled without select), "contact on device"
                         ///< (whatever the batch), or a baseline's row
  uint32_t size = 0;     ///< resolution or steps; 0: the family has one member
  uint32_t threads = 0;  ///< 0: as many as the device takes
  const BaselineRow* row = nullptr;

  std::string name() const { return size == 0 ? family : family + " " + std::to_string(size); }
};

/// What is measured on each case of a section, in the order of the file.
std::vector<ChartMethod> methodsOf(const std::string& section, const RunSettings& settings);

/// Fills the accuracy columns of a cell whose `certified` is set. `truth` is the reference's, `sizes` the sensors'.
void judge(Cell& cell, std::span<const Result> results, std::span<const Result> truth, std::span<const double> sizes);

/// Measures all and writes `record`, which comes without cells, after each cell. Where `folder` holds a record of the
/// same `run`, goes on after its cells. `step` is called before each cell.
Record measureAll(const RunSettings& settings, Record record, const Device& device, const std::filesystem::path& folder,
                  const std::function<void()>& step);

/// For the record's `run`: of this very program, the settings, and `origin`, which stands for all else.
std::string fingerprintOf(const RunSettings& settings, const std::string& origin);

}  // namespace radar::tools
