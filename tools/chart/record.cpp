#include "chart/record.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>

#include "batch/atomic_file.h"
#include "bench/csv.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr const char* kFormat = "# cyber-radar-chart-2";

// Calls visit(name, member) for each line of the head that is there once.
template <class SomeRecord, class Visit>
void eachOrigin(SomeRecord& record, const Visit& visit) {
  visit("command", record.command);
  visit("machine", record.machine);
  visit("device", record.device);
  visit("commit", record.commit);
  visit("date", record.date);
  visit("run", record.run);
}

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

// Returns false where there is no such key.
bool takeHead(Record& record, const std::string& key, const std::string& value) {
  bool isKnown = true;
  if (key == "workload") {
    const size_t end = std::min(value.find(": "), value.size());
    record.workloads.push_back({value.substr(0, end), value.substr(std::min(end + 2, value.size()))});
  } else if (key == "library") {
    record.notes.push_back(value);
  } else {
    isKnown = false;
    eachOrigin(record, [&](const char* name, std::string& member) {
      if (key != name) return;
      member = value;
      isKnown = true;
    });
  }
  return isKnown;
}

}  // namespace

std::string csvOf(const Record& record) {
  std::string text = std::string(kFormat) + "\n";
  const auto add = [&](const char* key, std::string value) {
    std::replace(value.begin(), value.end(), '\n', ' ');
    text += std::string("# ") + key + ": " + value + "\n";
  };
  eachOrigin(record, add);
  for (const WorkloadNote& workload : record.workloads) add("workload", workload.name + ": " + workload.about);
  for (const std::string& note : record.notes) add("library", note);
  text += bench::csvLine(columnNames());
  for (const Cell& cell : record.cells) {
    std::vector<std::string> cells;
    eachColumn(cell, [&](const char*, const auto& value) { cells.push_back(bench::csvCell(value)); });
    text += bench::csvLine(cells);
  }
  return text;
}

Record recordFrom(const std::string& csv, const std::string& file) {
  Record record;
  std::istringstream head(csv);
  std::string line;
  std::getline(head, line);
  if (line != kFormat) throw InputError(file, "line 1", std::string("expected ") + kFormat);
  for (size_t number = 2; std::getline(head, line) && line.starts_with("# "); ++number) {
    const size_t colon = std::min(line.find(": "), line.size() - 2);
    if (takeHead(record, line.substr(2, colon - 2), line.substr(colon + 2))) continue;
    throw InputError(file, "line " + std::to_string(number), "expected what cyber-radar chart writes, got " + line);
  }
  const std::vector<std::vector<std::string>> table = bench::readCsv(file, csv);
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
  if (!stream) return std::nullopt;
  return recordFrom({std::istreambuf_iterator<char>(stream), {}}, file.string());
}

void writeRecord(const std::filesystem::path& folder, const Record& record) {
  writeAtomically(folder / "chart.csv", csvOf(record));
}

}  // namespace radar::tools
