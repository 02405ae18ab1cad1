// A run on disk: chart.json, from which an interrupted run goes on and everything else is drawn anew, and chart.csv.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "chart/cell.h"

namespace radar::tools {

/// A workload, for the reader.
struct WorkloadNote {
  std::string name, about;
};

struct Record {
  std::string command, machine, device, commit, date;
  std::vector<WorkloadNote> workloads;  ///< of section front, in order
  std::vector<std::string> notes;       ///< what each peer cannot do: "name: text"
  std::vector<Cell> cells;

  const Cell* find(const std::string& key) const;
};

std::string jsonOf(const Record& record);
/// Throws InputError that names the file, the place and what was expected.
Record recordFrom(const std::string& json, const std::string& file);

/// A header, then a line for each cell.
std::string csvOf(const Record& record);

/// Nothing where the folder holds no chart.json.
std::optional<Record> readRecord(const std::filesystem::path& folder);
void writeRecord(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
