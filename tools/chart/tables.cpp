#include "chart/tables.h"

#include <algorithm>

#include "chart/findings.h"
#include "report/print.h"

namespace radar::tools {

namespace {

std::string percent(double share) {
  return share == 0 ? "-" : print("%.0f%%", 100 * share);
}

// Where each query went: "select 20%, contact 80%".
std::string tiersOf(const Cell& cell) {
  std::string text;
  const auto add = [&](const char* tier, double share) {
    if (share > 0) text += (text.empty() ? "" : ", ") + std::string(tier) + " " + percent(share);
  };
  add("select", cell.settledSelect);
  add("sampled", cell.settledSampled);
  add("contact", cell.settledContact);
  add("reference", cell.settledReference);
  return text.empty() ? "-" : text;
}

std::string certificateOf(const Cell& cell) {
  if (cell.violations > 0) return print("violated %u times", cell.violations);
  if (cell.certified) return "holds";
  return cell.family == "sampled" || cell.family == "drawing all" ? "upper bound only" : "none";
}

// A row for each method, a column for each x.
Table timesTable(const Record& record, const std::string& section, const std::string& workload,
                 const std::string& first) {
  const std::vector<const Cell*> cells = shownCells(record, section, workload);
  std::vector<double> xs;
  for (const Cell* cell : cells) xs.push_back(cell->x);
  std::sort(xs.begin(), xs.end());
  xs.erase(std::unique(xs.begin(), xs.end()), xs.end());
  Table table{{first}};
  for (const double x : xs) table[0].push_back(print("%.0f", x));
  for (const Cell* cell : cells) {
    auto line = std::find_if(table.begin() + 1, table.end(), [&](const auto& one) { return one[0] == cell->method; });
    if (line == table.end()) {
      line = table.insert(line, std::vector<std::string>(xs.size() + 1, "-"));
      (*line)[0] = cell->method;
    }
    const auto column = std::find(xs.begin(), xs.end(), cell->x) - xs.begin();
    (*line)[static_cast<size_t>(column) + 1] = inWords(cell->us);
  }
  return table;
}

}  // namespace

std::string inWords(double value) {
  return std::isnan(value) ? "-" : print(value < 1000 ? "%.3g" : "%.0f", value);
}

Table accuracyTable(const Record& record, const std::string& workload) {
  Table table{{"method", "contacts", "found", "missed", "false hits", "certificate", "error, median", "99%", "worst",
               "bracket, median", "99%", "worst", "settled by"}};
  for (const Cell* cell : shownCells(record, "front", workload)) {
    table.push_back({cell->method, std::to_string(cell->contacts), std::to_string(cell->found),
                     std::to_string(cell->misses), std::to_string(cell->falseHits), certificateOf(*cell),
                     inWords(cell->errorMedian), inWords(cell->error99), inWords(cell->errorWorst),
                     inWords(cell->widthMedian), inWords(cell->width99), inWords(cell->widthWorst), tiersOf(*cell)});
  }
  return table;
}

Table speedTable(const Record& record, const std::string& workload) {
  Table table{{"method", "threads", "us a query", "quartiles", "processor us", "scene change, us a query",
               "preparing once, ms"}};
  for (const Cell& cell : record.cells) {
    if (cell.section != "front" || cell.workload != workload) continue;
    const std::string threads = cell.threads == 0 ? "device" : std::to_string(cell.threads);
    if (cell.failed.empty()) {
      table.push_back({cell.method, threads, inWords(cell.us), inWords(cell.usLow) + " to " + inWords(cell.usHigh),
                       inWords(cell.cpuUs), inWords(cell.sceneUs), inWords(cell.prepareMs)});
    } else {
      table.push_back({cell.method, threads, cell.failed, "-", "-", "-", "-"});
    }
  }
  return table;
}

Table table1Table(const Record& record) {
  Table table = timesTable(record, "table1", "boxes", "us a query, boxes:");
  const auto add = [&](const char* name, double PaperRow::*ms) {
    std::vector<std::string>& line = table.emplace_back(table[0].size(), "-");
    line[0] = name;
    for (const PaperRow& row : paperTable1()) {
      const auto column = std::find(table[0].begin(), table[0].end(), print("%.0f", row.boxes));
      if (column != table[0].end()) line[static_cast<size_t>(column - table[0].begin())] = inWords(1000 * (row.*ms));
    }
  };
  add("the paper's Cyber Radar", &PaperRow::cyberRadar);
  add("the paper's OPCODE", &PaperRow::opcode);
  return table;
}

Table growthTable(const Record& record, const std::string& axis) {
  return timesTable(record, "growth", axis, "us a query, " + axis + ":");
}

}  // namespace radar::tools
