#include "measure/chart.h"

#include <algorithm>
#include <array>
#include <map>

#include "measure/plot.h"

namespace radar::tools {

namespace {

constexpr std::array kOurFamilies{"sampled", "drawing all", "contact", "contact on device", "reference"};

// Of style.gp.
constexpr int kFront = 21;
const std::map<std::string, int> kPaper{{"the paper's Cyber Radar", 22}, {"the paper's OPCODE", 23}};

bool isOurs(const std::string& family) {
  return std::find(kOurFamilies.begin(), kOurFamilies.end(), family) != kOurFamilies.end();
}

Repetition repetitionOf(Extent extent) {
  if (extent == Extent::full) return {.least = 5, .most = kNone, .seconds = 0.2};
  if (extent == Extent::quick) return {.least = 3, .most = kNone, .seconds = 0.03};
  return {.least = 1, .most = 1};
}

double flooredError(const Cell& cell) {
  return std::fmax(cell.errorWorst, 1e-13);
}

std::pair<double, double> rankOf(const Cell& cell) {
  return {cell.wrongShare(), flooredError(cell)};
}

// The paper's Table 1, in microseconds.
Cell ofPaper(const char* method, double boxes, double us) {
  Cell cell;
  cell.section = cell.workload = "table1";
  cell.method = cell.family = method;
  cell.x = boxes;
  cell.us = us;
  return cell;
}

bool has(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

// A row for each method, over all workloads without an axis.
Json methodTable(std::span<const Cell> cells) {
  Json table = Json::array();
  std::vector<std::string> workloads, methods;
  for (const Cell& cell : cells) {
    if (cell.x != 0) continue;
    if (!has(workloads, cell.workload)) workloads.push_back(cell.workload);
    if (cell.failed.empty() && !has(methods, cell.method)) methods.push_back(cell.method);
  }
  for (const std::string& method : methods) {
    uint32_t queries = 0, wrong = 0;
    double worstShare = 0, worstError = NAN, least = NAN, most = NAN;
    std::string fails;
    for (const std::string& workload : workloads) {
      const std::vector<const Cell*> shown = shownCells(cells, workload);
      const auto cell =
          std::find_if(shown.begin(), shown.end(), [&](const Cell* one) { return one->method == method; });
      if (cell == shown.end()) {
        fails += (fails.empty() ? "" : " ") + workload;
        continue;
      }
      queries += (*cell)->queries;
      wrong += (*cell)->misses + (*cell)->falseHits;
      worstShare = std::fmax(worstShare, (*cell)->wrongShare());
      worstError = std::fmax(worstError, (*cell)->errorWorst);
      least = std::fmin(least, (*cell)->us);
      most = std::fmax(most, (*cell)->us);
    }
    table.push_back({{"method", method},
                     {"wrong_percent", 100.0 * wrong / queries},
                     {"on_worst_workload", 100 * worstShare},
                     {"worst_error", worstError},
                     {"us_least", least},
                     {"us_most", most},
                     {"fails_on", fails}});
  }
  return table;
}

// A row of `workloads`, of one workload's shown cells.
Json workloadRow(const std::vector<const Cell*>& cells) {
  Json row{{"workload", cells[0]->workload}, {"queries", cells[0]->queries}, {"contacts", cells[0]->contacts}};
  for (const char* ours : {"contact", "contact on device", "reference", "sampled 64"}) row[ours] = NAN;
  const Cell* other = nullptr;
  for (const Cell* cell : cells) {
    if (row.contains(cell->method)) row[cell->method] = cell->us;
    if (isOurs(cell->family) || cell->wrongShare() > 0) continue;
    if (other == nullptr || cell->us < other->us) other = cell;
  }
  row["fastest_other_always_right"] = other == nullptr ? "none" : other->method;
  row["us"] = other == nullptr ? NAN : other->us;
  return row;
}

void addGrowth(Json& table, const std::vector<const Cell*>& cells) {
  for (const Cell* cell : cells) {
    const bool goesOn =
        !table.empty() && table.back()["workload"] == cell->workload && table.back()["method"] == cell->method;
    if (!goesOn) {
      table.push_back({{"workload", cell->workload},
                       {"method", cell->method},
                       {"least_x", cell->x},
                       {"us_at_least", cell->us},
                       {"most_x", cell->x},
                       {"us_at_most", cell->us},
                       {"ratio", 1.0}});
    }
    Json& row = table.back();
    row["most_x"] = cell->x;
    row["us_at_most"] = cell->us;
    row["ratio"] = cell->us / row["us_at_least"].get<double>();
  }
}

// A family has the same linetype in all charts.
std::map<std::string, int> linetypesOf(std::span<const Cell> cells) {
  std::map<std::string, int> linetypes;
  const auto number = [&](const std::string& family) { linetypes.emplace(family, 1 + linetypes.size()); };
  std::for_each(kOurFamilies.begin(), kOurFamilies.end(), number);
  for (const Cell& cell : cells) {
    if (!kPaper.contains(cell.family)) number(cell.family);
  }
  linetypes.insert(kPaper.begin(), kPaper.end());
  return linetypes;
}

Json frontRows(const std::vector<const Cell*>& cells, std::map<std::string, int>& linetypes) {
  Json rows = Json::array();
  const auto add = [&](const std::string& name, int linetype, const Cell& cell) {
    rows.push_back({{"name", name},
                    {"linetype", linetype},
                    {"size", cell.size},
                    {"us", cell.us},
                    {"wrong_percent", 100 * cell.wrongShare()},
                    {"worst_error", flooredError(cell)}});
  };
  for (const Cell* cell : cells) add(cell->family, linetypes[cell->family], *cell);
  for (const Cell* cell : frontOf(cells)) add("front", kFront, *cell);
  return rows;
}

Json lineRows(const std::vector<const Cell*>& cells, std::map<std::string, int>& linetypes) {
  Json rows = Json::array();
  for (const Cell* cell : cells) {
    rows.push_back({{"name", cell->method}, {"linetype", linetypes[cell->family]}, {"x", cell->x}, {"us", cell->us}});
  }
  return rows;
}

}  // namespace

void measureCases(const ChartSettings& settings, Json& report, const std::filesystem::path& folder,
                  const std::function<void()>& step) {
  Json cases = Json::array();
  for (const Case& one : settings.cases) {
    const Json row{{"section", one.section}, {"workload", one.workload}, {"about", one.about}, {"axis", one.axis}};
    if (cases.empty() || cases.back() != row) cases.push_back(row);
  }
  setRows(report, "cases", "What is measured", cases);
  for (size_t i = 0; i < settings.cases.size(); ++i) {
    const Case& one = settings.cases[i];
    Json& part = partOf(report, one.section, "Section " + one.section);
    const Stopwatch stopwatch;
    const Workload workload = one.make();
    const Truth truth = truthOf(workload);
    for (const Method& method : settings.methods(one.section)) {
      step();
      part["rows"].push_back(rowOf(tryOut(one, workload, method, truth, repetitionOf(settings.extent))));
    }
    const bool isLast = i + 1 == settings.cases.size() || settings.cases[i + 1].section != one.section;
    part["state"] = isLast ? "done" : "running";
    part["seconds"] = part["seconds"].get<double>() + stopwatch.lap().wall;
    writeReport(folder, report);
  }
}

Json rowOf(const Cell& cell) {
  Json row;
  eachColumn(cell, [&](const char* name, const auto& value) { row[name] = value; });
  return row;
}

std::vector<Cell> cellsOf(const Json& report) {
  std::vector<Cell> cells;
  for (const Json& part : report.at("parts")) {
    for (const Json& row : part.at("rows")) {
      if (!row.contains("us_median")) break;
      eachColumn(cells.emplace_back(), [&]<class Value>(const char* name, Value& value) {
        const Json& json = row.at(name);
        if constexpr (std::is_same_v<Value, double>) {
          value = json.is_null() ? NAN : json.get<double>();
        } else {
          json.get_to(value);
        }
      });
    }
    if (part["name"] != "table1") continue;
    for (const auto& [method, few, many] :
         {std::tuple("the paper's Cyber Radar", 14'730, 31'520), std::tuple("the paper's OPCODE", 11'270, 85'480)}) {
      cells.push_back(ofPaper(method, 10'000, few));
      cells.push_back(ofPaper(method, 30'000, many));
    }
  }
  return cells;
}

std::vector<const Cell*> shownCells(std::span<const Cell> cells, const std::string& workload) {
  std::vector<const Cell*> shown;
  for (const Cell& cell : cells) {
    if (cell.workload != workload || !cell.failed.empty()) continue;
    const auto same = std::find_if(shown.begin(), shown.end(), [&](const Cell* other) {
      return other->method == cell.method && other->x == cell.x;
    });
    if (same == shown.end()) {
      const auto isSameMethod = [&](const Cell* other) { return other->method == cell.method; };
      const auto after = std::find_if(shown.rbegin(), shown.rend(), isSameMethod).base();
      shown.insert(after == shown.begin() ? shown.end() : after, &cell);
    } else if (cell.us < (*same)->us) {
      *same = &cell;
    }
  }
  return shown;
}

std::vector<const Cell*> frontOf(std::span<const Cell* const> cells) {
  std::vector<const Cell*> sorted(cells.begin(), cells.end()), front;
  std::stable_sort(sorted.begin(), sorted.end(), [](const Cell* a, const Cell* b) {
    return std::pair(a->us, rankOf(*a)) < std::pair(b->us, rankOf(*b));
  });
  for (const Cell* cell : sorted) {
    if (front.empty() || rankOf(*cell) < rankOf(*front.back())) front.push_back(cell);
  }
  return front;
}

void sumUp(Json& report, const std::filesystem::path& folder, bool draws) {
  const std::vector<Cell> cells = cellsOf(report);
  std::map<std::string, int> linetypes = linetypesOf(cells);
  const bool hasOthers = std::any_of(cells.begin(), cells.end(), [](const Cell& cell) {
    return !isOurs(cell.family) && !kPaper.contains(cell.family);
  });
  const std::string origin = report.value("device", "") + "; " + report.at("processor").get<std::string>() +
                             "; commit " + report.at("commit").get<std::string>();
  Json workloads = Json::array(), growth = Json::array();
  for (Json& part : report["parts"]) part["charts"] = Json::array();
  const auto draw = [&](Json& part, const std::string& name, const char* script, const Json& rows,
                        const std::vector<std::string>& texts) {
    if (draws) drawFor(part, folder, name, plot(script, rows, texts));
  };
  const Json cases = partOf(report, "cases")["rows"];
  for (const Json& one : cases) {
    const std::string workload = one.at("workload"), axis = one.at("axis");
    const std::vector<const Cell*> shown = shownCells(cells, workload);
    if (shown.empty()) continue;
    std::string title = one.at("about");  // a colon begins a second line
    if (const size_t colon = title.find(": "); colon != std::string::npos) title.replace(colon, 2, "\n");
    Json& part = partOf(report, one.at("section"));
    if (axis.empty()) {
      workloads.push_back(workloadRow(shown));
      draw(part, "front-" + workload, kFrontScript, frontRows(shown, linetypes), {title, origin});
    } else {
      addGrowth(growth, shown);
      draw(part, workload, kLinesScript, lineRows(shown, linetypes),
           {title, origin, axis, hasOthers ? "filled: Cyber Radar\nhollow: other libraries" : "",
            "microseconds per query"});
    }
  }
  setRows(report, "workloads", "Each workload; microseconds per query", workloads);
  setRows(report, "methods", "Each method on all workloads; errors in sensor sizes", methodTable(cells));
  setRows(report, "growth", "As the work grows; microseconds per query", growth);
  writeReport(folder, report);
}

}  // namespace radar::tools
