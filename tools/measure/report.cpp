#include "measure/report.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <ctime>
#include <fstream>
#include <map>
#include <numeric>
#include <string_view>
#include <thread>
#include <vector>

#include "batch/atomic_file.h"
#include "commit/commit.h"
#include "import/input_error.h"

namespace radar::tools {

namespace {

constexpr size_t kWidth = 120;  // of lines of text

bool isNumber(const Json& value) {
  return value.is_number() || value.is_null();
}

// `exact`: with as many digits as it takes to read the same back.
std::string cellOf(const Json& value, bool exact = false) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (!value.is_number_float()) return value.dump();
  const auto number = value.get<double>();
  if (std::isnan(number)) return "";
  if (!exact) return std::abs(number) >= 1e4 ? print("%.0f", number) : print("%.4g", number);
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

std::string csvLine(const Json& values) {
  std::string line;
  for (const Json& value : values) {
    std::string cell = cellOf(value, true);
    if (cell.find_first_of(",\"\n#") != std::string::npos) {
      for (size_t at = 0; (at = cell.find('"', at)) != std::string::npos; at += 2) cell.insert(at, 1, '"');
      cell = '"' + cell + '"';
    }
    line += (&value == &*values.begin() ? "" : ",") + cell;
  }
  return line + "\n";
}

// The cells from `first` on, with their names, in lines that are as full as they may be.
std::string linesBelow(const std::vector<std::string>& names, const std::vector<std::string>& cells, size_t first,
                       const std::string& indent) {
  std::string text, line;
  for (size_t k = first; k < cells.size(); ++k) {
    if (cells[k].empty()) continue;
    const std::string item = names[k] + ": " + cells[k];
    if (!line.empty() && indent.size() + line.size() + 2 + item.size() > kWidth) {
      text += indent + line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : "; ") + item;
  }
  return line.empty() ? text : text + indent + line + "\n";
}

std::string today() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

std::string processorInWords() {
  std::string model = "a processor of unknown model";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    model = line.substr(line.find(':') + 2);
    break;
  }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads";
}

// What is neither a table nor said elsewhere, a line each.
std::string headText(const Json& report) {
  std::string text;
  for (const auto& [name, value] : report.items()) {
    if (name == "title" || name == "verdict" || name == "findings" || name == "parts" || value == "") continue;
    for (const Json& one : value.is_array() ? value : Json::array({value})) text += name + ": " + cellOf(one) + "\n";
  }
  return text;
}

std::string findingsText(const Json& report) {
  std::string text;
  for (const Json& line : report.value("findings", Json::array())) text += line.get<std::string>() + "\n";
  return text;
}

std::string stateText(const Json& part) {
  std::string text = part["state"];
  if (part["seconds"] > 0) text += print(", %.1f s", part["seconds"].get<double>());
  if (part["note"] != "") text += ": " + part["note"].get<std::string>();
  return text;
}

constexpr const char* kPageHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Cyber Radar</title><style>
body{max-width:1200px;margin:24px auto;padding:0 16px;font:16px/1.5 system-ui,sans-serif}
table{display:block;overflow-x:auto;border-collapse:collapse;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{padding:3px 14px 3px 4px;text-align:left;border-bottom:1px solid #ddd}
.bar{min-width:14em;background:linear-gradient(90deg,#9ecae9 var(--share),transparent var(--share))}
</style></head><body>
)";

std::string element(const std::string& tag, const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return "<" + tag + ">" + escaped + "</" + tag + ">\n";
}

// Rates have bars behind their numbers, and times that add up.
bool hasBar(std::string_view column, const Json& value) {
  return (column.ends_with("_per_s") || column == "us_per_query" || column == "times_as_fast") && value.is_number() &&
         std::isfinite(value.get<double>());
}

// The longest bar of each workload fills its cell.
std::string tableElement(const Json& table) {
  if (table.empty()) return "";
  std::map<std::string, double> greatest;
  for (const Json& row : table) {
    double& most = greatest[row.value("workload", "")];
    for (const auto& [name, value] : row.items()) {
      if (hasBar(name, value)) most = std::max(most, value.get<double>());
    }
  }
  std::string text = "<table><tr>\n";
  for (const auto& item : table.front().items()) {
    std::string name = item.key();
    std::replace(name.begin(), name.end(), '_', ' ');
    text += element("th", name);
  }
  for (const Json& row : table) {
    text += "<tr>\n";
    for (const auto& [name, value] : row.items()) {
      const double most = greatest[row.value("workload", "")];
      text += !hasBar(name, value)
                  ? element("td", cellOf(value))
                  : print("<td class=\"bar\" style=\"--share:%.1f%%\">", 100 * value.get<double>() / most) +
                        cellOf(value) + "</td>\n";
    }
  }
  return text + "</table>\n";
}

std::string pageOf(const Json& report) {
  std::string text = kPageHead + element("h1", report["title"]) + element("p", report["verdict"]) +
                     element("pre", findingsText(report) + headText(report));
  for (const Json& part : report["parts"]) {
    text += part["charts"].empty() ? "<details>" : "<details open>";
    text += element("summary", part["title"].get<std::string>() + ": " + stateText(part));
    for (const Json& chart : part["charts"]) text += "<img src=\"" + chart.get<std::string>() + ".svg\">\n";
    text += tableElement(part["rows"]) + "</details>\n";
  }
  return text + "</body></html>\n";
}

}  // namespace

std::string textOf(const Json& table, const std::string& indent) {
  if (table.empty()) return "";
  std::vector<std::vector<std::string>> lines(1);
  for (const auto& [name, value] : table.front().items()) lines[0].push_back(name);
  for (const Json& row : table) {
    std::vector<std::string>& cells = lines.emplace_back();
    for (const Json& value : row) cells.push_back(cellOf(value));
  }
  std::vector<size_t> widths(lines[0].size());
  for (const std::vector<std::string>& cells : lines) {
    for (size_t k = 0; k < cells.size(); ++k) widths[k] = std::max(widths[k], cells[k].size());
  }
  const auto isRight = [&](size_t k) {
    return isNumber(*std::next(table.front().begin(), static_cast<std::ptrdiff_t>(k)));
  };
  size_t inLine = widths.size();
  size_t width = std::accumulate(widths.begin(), widths.end(), indent.size() + 2 * (inLine - 1));
  for (; width > kWidth && inLine > 1; --inLine) width -= widths[inLine - 1] + 2;
  std::string text;
  for (const std::vector<std::string>& cells : lines) {
    std::string line = indent;
    for (size_t k = 0; k < inLine; ++k) {
      const std::string padding(widths[k] - cells[k].size(), ' ');
      line += (k == 0 ? "" : "  ") + (isRight(k) ? padding + cells[k] : cells[k] + padding);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
    if (&cells != &lines[0]) text += linesBelow(lines[0], cells, inLine, indent + "  ");
  }
  return text;
}

std::string csvOf(const Json& table) {
  if (table.empty()) return "";
  Json names = Json::array();
  for (const auto& [name, value] : table.front().items()) names.push_back(name);
  std::string text = csvLine(names);
  for (const Json& row : table) text += csvLine(row);
  return text;
}

Json newReport(const std::string& title, const Json& head) {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string command;
  for (std::string word; std::getline(file, word, '\0');) command += (command.empty() ? "" : " ") + word;
  Json report{{"title", title},     {"verdict", ""},   {"command", command},
              {"commit", commit()}, {"date", today()}, {"processor", processorInWords()}};
  report.update(head);
  report["parts"] = Json::array();
  return report;
}

Json& partOf(Json& report, const std::string& name, const std::string& title) {
  Json& parts = report["parts"];
  for (Json& part : parts) {
    if (part["name"] == name) return part;
  }
  return parts.emplace_back(Json{{"name", name},
                                 {"title", title},
                                 {"state", "not begun"},
                                 {"note", ""},
                                 {"seconds", 0.0},
                                 {"rows", Json::array()},
                                 {"charts", Json::array()}});
}

void setRows(Json& report, const std::string& name, const std::string& title, const Json& rows) {
  Json& part = partOf(report, name, title);
  part["state"] = "done";
  part["rows"] = rows;
}

std::string summaryOf(const Json& report) {
  std::string text = report["verdict"].get<std::string>() + "\n" + findingsText(report);
  for (const Json& part : report["parts"]) text += part["name"].get<std::string>() + ": " + stateText(part) + "\n";
  return text;
}

std::string reportText(const Json& report) {
  std::string text = summaryOf(report) + "\n" + headText(report);
  for (const Json& part : report["parts"]) {
    text += "\n" + part["title"].get<std::string>() + ": " + stateText(part) + "\n" + textOf(part["rows"], "  ");
  }
  return text;
}

void writeReport(const std::filesystem::path& folder, const Json& report) {
  writeAtomically(folder / "index.html", pageOf(report));
  writeAtomically(folder / "report.json", report.dump(2) + "\n");
  for (const Json& part : report["parts"]) {
    if (!part["rows"].empty())
      writeAtomically(folder / (part["name"].get<std::string>() + ".csv"), csvOf(part["rows"]));
  }
}

void makeFolder(const char* option, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (!std::filesystem::is_directory(folder)) throw InputError(option, folder, "expected a folder, or a place for one");
}

}  // namespace radar::tools
