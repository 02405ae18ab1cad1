// A run on disk: chart.csv, from which an interrupted run goes on and everything else is drawn anew.
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
  std::string run;                      ///< fingerprint of all that the cells depend on
  std::vector<WorkloadNote> workloads;  ///< of section front, in order
  std::vector<std::string> notes;       ///< what each baseline cannot do: "name: text"
  std::vector<Cell> cells;
};

/// Lines that begin with # say where the cells come from, the next names the columns, each other is a cell.
std::string csvOf(const Record& record);
/// Throws InputError that names the file, the place and what was expected.
Record recordFrom(const std::string& csv, const std::string& file);

/// Nothing where the folder holds no chart.csv.
std::optional<Record> readRecord(const std::filesystem::path& folder);
void writeRecord(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
