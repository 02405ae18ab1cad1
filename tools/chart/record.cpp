#include "chart/record.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "batch/whole_file.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "cyber-radar-chart-1";

struct ToJson {
  Json& row;
  void operator()(const char* name, double value) const { row[name] = std::isfinite(value) ? Json(value) : Json(); }
  template <class Value>
  void operator()(const char* name, const Value& value) const {
    row[name] = value;
  }
};

struct FromJson {
  const Json& row;
  void operator()(const char* name, double& value) const {
    const Json& found = row.at(name);
    value = found.is_null() ? NAN : found.get<double>();
  }
  template <class Value>
  void operator()(const char* name, Value& value) const {
    row.at(name).get_to(value);
  }
};

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
  json["cells"] = Json::array();
  for (const Cell& cell : record.cells) {
    Json row;
    eachColumn(cell, ToJson{row});
    json["cells"].push_back(std::move(row));
  }
  return json.dump(1) + "\n";
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
    for (const Json& row : json.at("cells")) eachColumn(record.cells.emplace_back(), FromJson{row});
    return record;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file, "", std::string("expected what cyber-radar chart writes: ") + error.what());
  }
}

std::string csvOf(const Record& record) {
  std::string header;
  const Cell none;
  eachColumn(none, [&](const char* name, const auto&) { header += (header.empty() ? "" : ",") + std::string(name); });
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
  writeWhole(folder / "chart.json", jsonOf(record));
  writeWhole(folder / "chart.csv", csvOf(record));
}

}  // namespace radar::tools
