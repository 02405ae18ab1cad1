// A run on disk: chart.csv, from which everything else is drawn again.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "measure/try_out.h"

namespace radar::tools {

struct Record {
  /// Lines "key: value" that say where the cells come from. Of several lines: `workload`, for each of section front its
  /// name and what it is, "name: about"; `library`, what each baseline cannot do.
  std::vector<std::string> head;
  std::vector<Cell> cells;

  void add(const std::string& key, const std::string& value);
  std::vector<std::string> values(const std::string& key) const;
};

/// The head's lines begin with #, the next names the columns, each other is a cell.
std::string csvOf(const Record& record);
/// Throws InputError that names the file, the place and what was expected.
Record recordFrom(const std::string& csv, const std::string& file);

/// Nothing where the folder holds no chart.csv.
std::optional<Record> readRecord(const std::filesystem::path& folder);
void writeRecord(const std::filesystem::path& folder, const Record& record);

}  // namespace radar::tools
