#include "chart/record.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

#include "batch/atomic_file.h"
#include "import/input_error.h"
#include "report/tables.h"

namespace radar::tools {

namespace {

std::vector<std::string> columnNames() {
  std::vector<std::string> names;
  const Cell none;
  eachColumn(none, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

// Reads the columns of a line, one after the other.
struct FromCsv {
  const std::string& file;
  const std::string& place;
  const std::vector<std::string>& cells;
  size_t& next;

  template <class Value>
  void operator()(const char* name, Value& value) const {
    const std::string& cell = cells[next++];
    const auto expected = [&](const char* what) {
      throw InputError(file, place + ": " + name, std::string("expected ") + what + ", got \"" + cell + "\"");
    };
    if constexpr (std::is_same_v<Value, std::string>) {
      value = cell;
    } else if constexpr (std::is_same_v<Value, bool>) {
      if (cell != "yes" && cell != "no") expected("yes or no");
      value = cell == "yes";
    } else {
      if constexpr (std::is_floating_point_v<Value>) {
        value = NAN;
        if (cell.empty()) return;
      }
      const char* end = cell.data() + cell.size();
      const auto [stop, error] = std::from_chars(cell.data(), end, value);
      if (error != std::errc() || stop != end) expected("a number");
    }
  }
};

}  // namespace

void Record::add(const std::string& key, const std::string& value) {
  std::string& line = head.emplace_back(key + ": " + value);
  std::replace(line.begin(), line.end(), '\n', ' ');
}

std::vector<std::string> Record::values(const std::string& key) const {
  std::vector<std::string> values;
  for (const std::string& line : head) {
    if (line.starts_with(key + ": ")) values.push_back(line.substr(key.size() + 2));
  }
  return values;
}

std::string csvOf(const Record& record) {
  std::string text;
  for (const std::string& line : record.head) text += "# " + line + "\n";
  text += csvLine(columnNames());
  for (const Cell& cell : record.cells) {
    Json values = Json::array();
    eachColumn(cell, [&](const char*, const auto& value) { values.push_back(value); });
    text += csvLine(values);
  }
  return text;
}

Record recordFrom(const std::string& csv, const std::string& file) {
  Record record;
  std::istringstream head(csv);
  for (std::string line; std::getline(head, line) && line.starts_with("# ");) record.head.push_back(line.substr(2));
  const std::vector<std::vector<std::string>> table = readCsv(file, csv);
  if (table.empty() || table.front() != columnNames()) {
    throw InputError(file, "columns", "expected those that this program writes");
  }
  for (size_t row = 1; row < table.size(); ++row) {
    const std::string place = "row " + std::to_string(row);
    if (table[row].size() != table.front().size()) {
      throw InputError(
          file, place,
          "expected " + std::to_string(table.front().size()) + " cells, got " + std::to_string(table[row].size()));
    }
    size_t next = 0;
    eachColumn(record.cells.emplace_back(), FromCsv{file, place, table[row], next});
  }
  return record;
}

std::optional<Record> readRecord(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "chart.csv";
  std::ifstream stream(file, std::ios::binary);
  if (!stream || isStream(file)) return std::nullopt;
  return recordFrom({std::istreambuf_iterator<char>(stream), {}}, file.string());
}

void writeRecord(const std::filesystem::path& folder, const Record& record) {
  writeAtomically(folder / "chart.csv", csvOf(record));
}

}  // namespace radar::tools
