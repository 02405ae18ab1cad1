#include "chart/record.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "batch/atomic_file.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "cyber-radar-chart-1";

struct ToJson {
  Json& row;
  void operator()(const char*, double value) const { row.push_back(std::isfinite(value) ? Json(value) : Json()); }
  template <class Value>
  void operator()(const char*, const Value& value) const {
    row.push_back(value);
  }
};

struct FromJson {
  const Json& row;
  size_t& next;
  void operator()(const char*, double& value) const {
    const Json& found = row.at(next++);
    value = found.is_null() ? NAN : found.get<double>();
  }
  template <class Value>
  void operator()(const char*, Value& value) const {
    row.at(next++).get_to(value);
  }
};

std::vector<std::string> columnNames() {
  std::vector<std::string> names;
  const Cell none;
  eachColumn(none, [&](const char* name, const auto&) { names.emplace_back(name); });
  return names;
}

// Names may hold commas and quotes.
struct ToCsv {
  std::string& line;
  void add(const std::string& text) const { line += (line.empty() ? "" : ",") + text; }
  void operator()(const char*, const std::string& value) const {
    std::string quoted = "\"";
    for (const char c : value) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
    add(value.find_first_of(",\"\n") == std::string::npos ? value : quoted + "\"");
  }
  void operator()(const char*, double value) const {
    std::string text;
    if (std::isfinite(value)) appendNumber(text, value);
    add(text);
  }
  void operator()(const char*, uint32_t value) const { add(std::to_string(value)); }
  void operator()(const char*, bool value) const { add(value ? "yes" : "no"); }
};

}  // namespace

const Cell* Record::find(const std::string& key) const {
  const auto found = std::find_if(cells.begin(), cells.end(), [&](const Cell& cell) { return cell.key == key; });
  return found == cells.end() ? nullptr : &*found;
}

std::string jsonOf(const Record& record) {
  Json json{{"format", kFormat},       {"command", record.command}, {"machine", record.machine},
            {"device", record.device}, {"commit", record.commit},   {"date", record.date}};
  json["workloads"] = Json::array();
  for (const WorkloadNote& note : record.workloads) {
    json["workloads"].push_back({{"name", note.name}, {"about", note.about}});
  }
  json["notes"] = record.notes;
  json["columns"] = columnNames();
  // A line for each cell.
  std::string text = json.dump(1);
  text.erase(text.size() - 2);  // the end of the object
  text += ",\n \"cells\": [";
  for (const Cell& cell : record.cells) {
    Json row = Json::array();
    eachColumn(cell, ToJson{row});
    text += (&cell == &record.cells.front() ? "\n  " : ",\n  ") + row.dump();
  }
  return text + "\n ]\n}\n";
}

Record recordFrom(const std::string& text, const std::string& file) {
  try {
    const Json json = Json::parse(text);
    if (json.at("format") != kFormat) throw InputError(file, "format", std::string("expected ") + kFormat);
    Record record;
    json.at("command").get_to(record.command);
    json.at("machine").get_to(record.machine);
    json.at("device").get_to(record.device);
    json.at("commit").get_to(record.commit);
    json.at("date").get_to(record.date);
    for (const Json& note : json.at("workloads")) record.workloads.push_back({note.at("name"), note.at("about")});
    json.at("notes").get_to(record.notes);
    if (json.at("columns").get<std::vector<std::string>>() != columnNames()) {
      throw InputError(file, "columns", "expected those that this program writes");
    }
    for (const Json& row : json.at("cells")) {
      size_t next = 0;
      eachColumn(record.cells.emplace_back(), FromJson{row, next});
    }
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "", std::string("expected what cyber-radar chart writes: ") + error.what());
  }
}

std::string csvOf(const Record& record) {
  std::string header;
  for (const std::string& name : columnNames()) header += (header.empty() ? "" : ",") + name;
  std::string text = header + "\n";
  for (const Cell& cell : record.cells) {
    std::string line;
    eachColumn(cell, ToCsv{line});
    text += line + "\n";
  }
  return text;
}

std::optional<Record> readRecord(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "chart.json";
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  return recordFrom({std::istreambuf_iterator<char>(stream), {}}, file.string());
}

void writeRecord(const std::filesystem::path& folder, const Record& record) {
  writeAtomically(folder / "chart.json", jsonOf(record));
  writeAtomically(folder / "chart.csv", csvOf(record));
}

}  // namespace radar::tools
