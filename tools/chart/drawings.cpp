#include "chart/drawings.h"

#include <algorithm>
#include <array>

#include "chart/findings.h"
#include "report/log_chart.h"
#include "report/print.h"

namespace radar::tools {

namespace {

struct Look {
  const char* family;  ///< how its name starts
  int colour;
  bool ours;
};
constexpr std::array kLooks{Look{"sampled", 0, true}, Look{"drawing all", 0, true}, Look{"bounded", 2, true},
                            Look{"contact", 1, true}, Look{"reference", 6, true},   Look{"Embree", 3, false},
                            Look{"FCL", 4, false},    Look{"Bullet", 5, false},     Look{"ODE", 7, false}};

// Ours are filled, others hollow.
LogLine lineFor(const std::string& family, const std::string& name) {
  LogLine line;
  line.name = name;
  const auto look =
      std::find_if(kLooks.begin(), kLooks.end(), [&](const Look& known) { return family.starts_with(known.family); });
  line.colour = look == kLooks.end() ? kLooks.back().colour : look->colour;
  line.hollow = look == kLooks.end() || !look->ours;
  return line;
}

std::string tipOf(const Cell& cell) {
  std::string text = cell.method + print(": %.4g us a query", cell.us);
  if (cell.threads > 1) text += print(", %u threads", cell.threads);
  text += print("; of %u contacts %u missed, %u false hits", cell.contacts, cell.misses, cell.falseHits);
  if (!std::isnan(cell.errorWorst)) text += print("; worst error %.3g of the sensor's size", cell.errorWorst);
  if (cell.certified) text += print("; brackets violated: %u", cell.violations);
  return text;
}

LogPoint pointOf(const Cell& cell) {
  LogPoint point;
  point.x = cell.us;
  point.y = std::isnan(cell.errorWorst) ? 0 : cell.errorWorst;
  point.missed = wrongShare(cell);
  if (cell.size > 0) point.label = std::to_string(cell.size);
  point.tip = tipOf(cell);
  return point;
}

// A line for each family, in the order of appearance.
std::vector<LogLine> linesOf(const std::vector<const Cell*>& cells) {
  std::vector<LogLine> lines;
  for (const Cell* cell : cells) {
    auto line = std::find_if(lines.begin(), lines.end(), [&](const LogLine& one) { return one.name == cell->family; });
    if (line == lines.end()) line = lines.insert(line, lineFor(cell->family, cell->family));
    line->points.push_back(pointOf(*cell));
  }
  return lines;
}

// The times of each method of a section over x, the fitted slope in its name.
std::vector<LogLine> timeLines(const Record& record, const std::string& section, const std::string& workload,
                               bool withSlopes) {
  std::vector<LogLine> lines;
  for (const Cell* cell : shownCells(record, section, workload)) {
    auto line = std::find_if(lines.begin(), lines.end(), [&](const LogLine& one) { return one.name == cell->method; });
    if (line == lines.end()) line = lines.insert(line, lineFor(cell->family, cell->method));
    line->points.push_back({cell->x, cell->us, 0, "", tipOf(*cell)});
  }
  if (!withSlopes) return lines;
  for (LogLine& line : lines) {
    std::vector<Point> points;
    for (const LogPoint& point : line.points) points.push_back({point.x, point.y});
    if (points.size() > 1) line.name += print(" (^%.2f)", slopeOf(points));
  }
  return lines;
}

std::vector<Drawing> resolutionDrawings(const Record& record, const WorkloadNote& workload) {
  LogChart chart;
  chart.title = "Time against resolution: " + workload.about;
  chart.xName = "pixels, or rays, of the longer side";
  chart.yName = "microseconds a query";
  for (const Cell* cell : shownCells(record, "front", workload.name)) {
    const bool hasPixels = cell->family == "sampled" || cell->family == "bounded" || cell->family == "Embree rays";
    if (!hasPixels || cell->size == 0) continue;
    auto line = std::find_if(chart.lines.begin(), chart.lines.end(),
                             [&](const LogLine& one) { return one.name == cell->family; });
    if (line == chart.lines.end()) line = chart.lines.insert(line, lineFor(cell->family, cell->family));
    line->points.push_back({static_cast<double>(cell->size), cell->us, 0, "", tipOf(*cell)});
  }
  for (LogLine& line : chart.lines) {
    std::vector<Point> points;
    for (const LogPoint& point : line.points) points.push_back({point.x, point.y});
    if (points.size() > 1) line.name += print(" (^%.2f)", slopeOf(points));
  }
  if (chart.lines.empty()) return {};
  return {{"growth-resolution", chart.title, {}, logChart(chart)}};
}

}  // namespace

Drawing frontDrawing(const Record& record, const WorkloadNote& workload) {
  const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
  LogChart chart;
  chart.title = workload.about;
  chart.xName = "microseconds a query, in as many threads as suit the method (left is faster)";
  chart.yName = "worst error, sensor sizes (lower is better)";
  chart.floor = kErrorFloor;
  chart.floorName = print("%g or less, zero too", kErrorFloor);
  chart.missedName = "Wrong answers: contacts missed or invented, share of queries";
  chart.lines = linesOf(cells);
  for (const Cell* cell : frontOf(cells)) chart.front.push_back(pointOf(*cell));
  Drawing drawing{"front-" + workload.name, workload.about, {}, logChart(chart)};
  drawing.notes.push_back(print(
      "%u queries, %u with a contact. Filled: Cyber Radar; hollow: others; numbers: pixels, rays or steps; crossed: "
      "some answers are wrong. The broad line is the front: nothing is both faster and more right.",
      cells.empty() ? 0 : cells[0]->queries, cells.empty() ? 0 : cells[0]->contacts));
  for (const Cell* cell : failedCells(record, "front", workload.name)) {
    drawing.notes.push_back("Not drawn: " + cell->method + " " + cell->failed + ".");
  }
  return drawing;
}

Drawing table1Drawing(const Record& record) {
  LogChart chart;
  chart.title = "The paper's Table 1: teapots among 10,000 to 30,000 boxes";
  chart.xName = "boxes";
  chart.yName = "microseconds a query";
  chart.lines = timeLines(record, "table1", "boxes", false);
  LogLine radar{"the paper's Cyber Radar", 6, false, true, {}}, opcode{"the paper's OPCODE", 6, false, true, {}};
  for (const PaperRow& row : paperTable1()) {
    radar.points.push_back({row.boxes, 1000 * row.cyberRadar, 0, "", ""});
    opcode.points.push_back({row.boxes, 1000 * row.opcode, 0, "", ""});
  }
  chart.lines.push_back(radar);
  chart.lines.push_back(opcode);
  return {"table1",
          chart.title,
          {"Dashed: what the paper measured on its machine, the first and last of its rows."},
          logChart(chart)};
}

std::vector<Drawing> growthDrawings(const Record& record) {
  struct Axis {
    const char *name, *title, *xName;
  };
  constexpr std::array kAxes{Axis{"boxes", "More of the scene: teapots among boxes at one density", "boxes"},
                             Axis{"sensors", "Larger batches: boxes among 10,000 boxes", "sensors in the batch"},
                             Axis{"triangles", "Finer meshes: rings among 200 rings", "triangles of each mesh"}};
  std::vector<Drawing> drawings;
  for (const Axis& axis : kAxes) {
    LogChart chart;
    chart.title = axis.title;
    chart.xName = axis.xName;
    chart.yName = "microseconds a query";
    chart.lines = timeLines(record, "growth", axis.name, true);
    if (chart.lines.empty()) continue;
    drawings.push_back({std::string("growth-") + axis.name, axis.title, {}, logChart(chart)});
  }
  if (!record.workloads.empty()) {
    for (const Drawing& drawing : resolutionDrawings(record, record.workloads.front())) drawings.push_back(drawing);
  }
  for (Drawing& drawing : drawings) {
    drawing.notes.push_back("In brackets: the exponent p of time ~ x^p, fitted by least squares of logarithms.");
  }
  return drawings;
}

std::vector<Drawing> drawingsOf(const Record& record) {
  std::vector<Drawing> drawings;
  for (const WorkloadNote& workload : record.workloads) drawings.push_back(frontDrawing(record, workload));
  if (!shownCells(record, "table1", "boxes").empty()) drawings.push_back(table1Drawing(record));
  for (Drawing& drawing : growthDrawings(record)) drawings.push_back(std::move(drawing));
  return drawings;
}

}  // namespace radar::tools
