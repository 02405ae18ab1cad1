#include "chart/charts.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "batch/atomic_file.h"
#include "plot/plot.h"

namespace radar::tools {

namespace {

constexpr std::array kOurFamilies{"sampled", "drawing all", "contact", "contact on device", "reference"};

// The paper's Table 1: microseconds for the fewest boxes and the most.
struct PaperTimes {
  const char* name;
  int linetype;
  double few, many;
};
constexpr double kFewBoxes = 10'000, kManyBoxes = 30'000;
constexpr PaperTimes kPaper[] = {{"the paper's Cyber Radar", 22, 14'730, 31'520},
                                 {"the paper's OPCODE", 23, 11'270, 85'480}};

// Of plot/style.gp.
constexpr int kFront = 21;
constexpr const char* kResolutionChart = "growth-resolution";

bool isOurs(const std::string& family) {
  return std::find(kOurFamilies.begin(), kOurFamilies.end(), family) != kOurFamilies.end();
}

double flooredError(const Cell& cell) {
  return std::fmax(cell.errorWorst, 1e-13);
}

std::pair<double, double> rankOf(const Cell& cell) {
  return {cell.wrongShare(), flooredError(cell)};
}

struct WorkloadNote {
  std::string name, about;
};

std::vector<WorkloadNote> workloadsOf(const Record& record) {
  std::vector<WorkloadNote> workloads;
  for (const std::string& value : record.values("workload")) {
    const size_t end = std::min(value.find(": "), value.size());
    workloads.push_back({value.substr(0, end), value.substr(std::min(end + 2, value.size()))});
  }
  return workloads;
}

// A chart in which x grows.
struct Axis {
  const char *chart, *section, *workload, *title, *xLabel;
};
constexpr Axis kAxes[] = {
    {"table1", "table1", "boxes", "The paper's Table 1: teapots among boxes", "boxes"},
    {"growth-boxes", "growth", "boxes", "More of the scene: teapots among boxes at one density", "boxes"},
    {"growth-sensors", "growth", "sensors", "Larger batches: boxes among 10,000 boxes", "sensors in the batch"},
    {"growth-triangles", "growth", "triangles", "Finer meshes: rings among 200 rings", "triangles of each mesh"}};

bool hasPaperTimes(const Axis& axis) {
  return axis.section == std::string("table1");
}

// gnuplot has its own rules for quotation marks and backslashes in CSV files: fields are without.
std::string field(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || std::strchr("\",\\", c) != nullptr) c = ' ';
  }
  return text;
}

// A point where x grows.
Json pointAt(const std::string& chart, const std::string& name, int linetype, double x, double us) {
  return {{"chart", chart}, {"name", field(name)},      {"linetype", linetype},  {"size", nullptr}, {"x", x},
          {"us", us},       {"wrong_percent", nullptr}, {"worst_error", nullptr}};
}

Json frontPoint(const std::string& chart, const std::string& name, int linetype, const Cell& cell) {
  return {{"chart", chart},
          {"name", field(name)},
          {"linetype", linetype},
          {"size", cell.size},
          {"x", nullptr},
          {"us", cell.us},
          {"wrong_percent", 100 * cell.wrongShare()},
          {"worst_error", flooredError(cell)}};
}

// The rows of points.csv. A family has the same linetype in all charts.
Json pointsOf(const Record& record) {
  std::map<std::string, int> linetypes;
  const auto number = [&](const std::string& family) { linetypes.emplace(family, 1 + linetypes.size()); };
  std::for_each(kOurFamilies.begin(), kOurFamilies.end(), number);
  for (const Cell& cell : record.cells) number(cell.family);
  Json points = Json::array();
  for (const WorkloadNote& workload : workloadsOf(record)) {
    const std::string chart = "front-" + workload.name;
    const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
    for (const Cell* cell : cells) points.push_back(frontPoint(chart, cell->family, linetypes[cell->family], *cell));
    for (const Cell* cell : frontOf(cells)) points.push_back(frontPoint(chart, "front", kFront, *cell));
    if (workload.name != workloadsOf(record).front().name) continue;
    for (const Cell* cell : cells) {
      if (cell->family != "sampled" && cell->family != "Embree rays") continue;
      points.push_back(pointAt(kResolutionChart, cell->family, linetypes[cell->family], cell->size, cell->us));
    }
  }
  for (const Axis& axis : kAxes) {
    const std::vector<const Cell*> cells = shownCells(record, axis.section, axis.workload);
    for (const Cell* cell : cells) {
      points.push_back(pointAt(axis.chart, cell->method, linetypes[cell->family], cell->x, cell->us));
    }
    if (cells.empty() || !hasPaperTimes(axis)) continue;
    for (const PaperTimes& times : kPaper) {
      points.push_back(pointAt(axis.chart, times.name, times.linetype, kFewBoxes, times.few));
      points.push_back(pointAt(axis.chart, times.name, times.linetype, kManyBoxes, times.many));
    }
  }
  return points;
}

}  // namespace

std::vector<const Cell*> shownCells(const Record& record, const std::string& section, const std::string& workload) {
  std::vector<const Cell*> cells;
  for (const Cell& cell : record.cells) {
    if (cell.section != section || cell.workload != workload || !cell.failed.empty()) continue;
    const auto same = std::find_if(cells.begin(), cells.end(), [&](const Cell* other) {
      return other->method == cell.method && other->x == cell.x;
    });
    if (same == cells.end()) {
      const auto isSameMethod = [&](const Cell* other) { return other->method == cell.method; };
      const auto after = std::find_if(cells.rbegin(), cells.rend(), isSameMethod).base();
      cells.insert(after == cells.begin() ? cells.end() : after, &cell);
    } else if (cell.us < (*same)->us) {
      *same = &cell;
    }
  }
  return cells;
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

Json methodTable(const Record& record) {
  std::vector<std::string> methods;
  for (const Cell& cell : record.cells) {
    const bool isNew = std::find(methods.begin(), methods.end(), cell.method) == methods.end();
    if (cell.section == "front" && cell.failed.empty() && isNew) methods.push_back(cell.method);
  }
  Json table = Json::array();
  for (const std::string& method : methods) {
    uint32_t queries = 0, wrong = 0;
    double worstShare = 0, worstError = NAN, least = NAN, most = NAN;
    std::string fails;
    for (const WorkloadNote& workload : workloadsOf(record)) {
      const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
      const auto cell =
          std::find_if(cells.begin(), cells.end(), [&](const Cell* one) { return one->method == method; });
      if (cell == cells.end()) {
        fails += (fails.empty() ? "" : " ") + workload.name;
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

Json workloadTable(const Record& record) {
  Json table = Json::array();
  for (const WorkloadNote& workload : workloadsOf(record)) {
    const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
    if (cells.empty()) continue;
    Json row{{"workload", workload.name}, {"queries", cells[0]->queries}, {"contacts", cells[0]->contacts}};
    for (const char* ours : {"contact", "contact on device", "reference", "sampled 64"}) row[ours] = NAN;
    const Cell* other = nullptr;
    for (const Cell* cell : cells) {
      if (row.contains(cell->method)) row[cell->method] = cell->us;
      if (isOurs(cell->family) || cell->wrongShare() > 0) continue;
      if (other == nullptr || cell->us < other->us) other = cell;
    }
    row["fastest_other_always_right"] = other == nullptr ? "none" : other->method;
    row["us"] = other == nullptr ? NAN : other->us;
    table.push_back(std::move(row));
  }
  return table;
}

Json growthTable(const Record& record) {
  Json table = Json::array();
  for (const Axis& axis : kAxes) {
    const auto add = [&](const std::string& method, double few, double fewUs, double many, double manyUs) {
      table.push_back({{"chart", axis.chart},
                       {"method", method},
                       {"least_x", few},
                       {"us_at_least", fewUs},
                       {"most_x", many},
                       {"us_at_most", manyUs},
                       {"ratio", manyUs / fewUs}});
    };
    const std::vector<const Cell*> cells = shownCells(record, axis.section, axis.workload);
    for (size_t first = 0, next = 0; first < cells.size(); first = next) {
      while (next < cells.size() && cells[next]->method == cells[first]->method) ++next;
      const Cell &few = *cells[first], &many = *cells[next - 1];
      if (few.x < many.x) add(few.method, few.x, few.us, many.x, many.us);
    }
    if (cells.empty() || !hasPaperTimes(axis)) continue;
    for (const PaperTimes& times : kPaper) add(times.name, kFewBoxes, times.few, kManyBoxes, times.many);
  }
  return table;
}

void writeCharts(const std::filesystem::path& folder, const Record& record) {
  writeAtomically(folder / "methods.csv", csvOf(methodTable(record)));
  writeAtomically(folder / "workloads.csv", csvOf(workloadTable(record)));
  writeAtomically(folder / "growth.csv", csvOf(growthTable(record)));
  const Json points = pointsOf(record);
  const std::filesystem::path file = folder / "points.csv";
  writeAtomically(file, csvOf(points));
  // Charts without points are left out. A colon in a title begins a second line.
  std::string origin;
  for (const char* key : {"device", "machine", "commit"}) {
    for (const std::string& value : record.values(key)) {
      origin += (origin.empty() ? "" : "; ") + (key == std::string("commit") ? "commit " + value : value);
    }
  }
  const auto draw = [&](const std::string& chart, std::string title, const std::string& xLabel) {
    if (std::none_of(points.begin(), points.end(), [&](const Json& point) { return point["chart"] == chart; })) return;
    if (const size_t colon = title.find(": "); colon != std::string::npos) title.replace(colon, 2, "\n");
    const char* script = xLabel.empty() ? kFrontScript : kTimesScript;
    writeAtomically(folder / (chart + ".svg"), plot(script, file, {chart, title, xLabel, origin}));
  };
  const std::vector<WorkloadNote> workloads = workloadsOf(record);
  for (const WorkloadNote& workload : workloads) draw("front-" + workload.name, workload.about, "");
  for (const Axis& axis : kAxes) draw(axis.chart, axis.title, axis.xLabel);
  if (workloads.empty()) return;
  draw(kResolutionChart, "Time against resolution: " + workloads[0].about, "pixels, or rays, of the longer side");
}

}  // namespace radar::tools
