#include "chart/drawings.h"

#include <algorithm>
#include <array>
#include <map>

#include "chart/findings.h"
#include "report/print.h"

namespace radar::tools {

namespace {

struct Look {
  const char* family;  ///< how its name starts
  int colour;
  Mark mark;
};
constexpr std::array kLooks{Look{"sampled", 0, Mark::circle},
                            Look{"drawing all", 0, Mark::square},
                            Look{"contact on device", 2, Mark::diamond},
                            Look{"contact", 1, Mark::diamond},
                            Look{"reference", 6, Mark::triangle},
                            Look{"Embree rays", 3, Mark::circle},
                            Look{"Embree vertex rays", 3, Mark::diamond},
                            Look{"FCL", 4, Mark::square},
                            Look{"Bullet hull", 5, Mark::circle},
                            Look{"Bullet triangles", 5, Mark::triangle},
                            Look{"ODE", 7, Mark::diamond}};

constexpr const char* kKey =
    "filled: Cyber Radar; hollow: other libraries; crosses: some answers are wrong; numbers: pixels, rays or steps";

// What stands before the colon is the title, the rest a line below it.
void setTitle(Chart& chart, const std::string& caption) {
  const size_t colon = caption.find(": ");
  chart.title = caption.substr(0, colon);
  if (colon != std::string::npos) chart.about.push_back(caption.substr(colon + 2));
}

// Ours are filled, others hollow.
ChartLine lineFor(const std::string& family, const std::string& name) {
  ChartLine line;
  line.name = name;
  const auto look =
      std::find_if(kLooks.begin(), kLooks.end(), [&](const Look& known) { return family.starts_with(known.family); });
  line.hollow = !isOurs(family);
  if (look == kLooks.end()) return line;
  line.colour = look->colour;
  line.mark = look->mark;
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

ChartPoint pointOf(const Cell& cell) {
  ChartPoint point;
  point.x = cell.us;
  constexpr double kMost = 1e200;  // that an axis can hold
  point.y = std::isnan(cell.errorWorst) ? 0 : std::min(cell.errorWorst, kMost);
  point.missed = wrongShare(cell);
  if (cell.size > 0) point.label = std::to_string(cell.size);
  point.tip = tipOf(cell);
  return point;
}

// A line for each family, in the order of appearance.
std::vector<ChartLine> linesOf(const std::vector<const Cell*>& cells) {
  std::vector<ChartLine> lines;
  for (const Cell* cell : cells) {
    auto line =
        std::find_if(lines.begin(), lines.end(), [&](const ChartLine& one) { return one.name == cell->family; });
    if (line == lines.end()) line = lines.insert(line, lineFor(cell->family, cell->family));
    line->points.push_back(pointOf(*cell));
  }
  return lines;
}

// The times of each method of a section over x, the fitted slope in its name.
std::vector<ChartLine> timeLines(const Record& record, const std::string& section, const std::string& workload,
                                 bool withSlopes) {
  std::vector<ChartLine> lines;
  for (const Cell* cell : shownCells(record, section, workload)) {
    auto line =
        std::find_if(lines.begin(), lines.end(), [&](const ChartLine& one) { return one.name == cell->method; });
    if (line == lines.end()) line = lines.insert(line, lineFor(cell->family, cell->method));
    line->points.push_back({cell->x, cell->us, 0, "", tipOf(*cell)});
  }
  if (!withSlopes) return lines;
  for (ChartLine& line : lines) {
    std::vector<Point> points;
    for (const ChartPoint& point : line.points) points.push_back({point.x, point.y});
    if (points.size() > 1) line.name += print(" (^%.2f)", slopeOf(points));
  }
  return lines;
}

std::vector<Drawing> resolutionDrawings(const Record& record, const WorkloadNote& workload) {
  Chart chart;
  const std::string caption = "Time against resolution: " + workload.about;
  setTitle(chart, caption);
  chart.xName = "pixels, or rays, of the longer side";
  chart.yName = "microseconds a query";
  for (const Cell* cell : shownCells(record, "front", workload.name)) {
    const bool hasPixels = cell->family == "sampled" || cell->family == "Embree rays";
    if (!hasPixels || cell->size == 0) continue;
    auto line = std::find_if(chart.lines.begin(), chart.lines.end(),
                             [&](const ChartLine& one) { return one.name == cell->family; });
    if (line == chart.lines.end()) line = chart.lines.insert(line, lineFor(cell->family, cell->family));
    line->points.push_back({static_cast<double>(cell->size), cell->us, 0, "", tipOf(*cell)});
  }
  for (ChartLine& line : chart.lines) {
    std::vector<Point> points;
    for (const ChartPoint& point : line.points) points.push_back({point.x, point.y});
    if (points.size() > 1) line.name += print(" (^%.2f)", slopeOf(points));
  }
  if (chart.lines.empty()) return {};
  return {{"growth-resolution", caption, {}, chart}};
}

// Those that failed alike in one note.
std::vector<std::string> failureNotes(const std::vector<const Cell*>& failed) {
  std::map<std::string, std::vector<const Cell*>> byReason;
  for (const Cell* cell : failed) {
    std::vector<const Cell*>& cells = byReason[cell->failed];
    if (cells.empty() || cells.back()->method != cell->method) cells.push_back(cell);
  }
  std::vector<std::string> notes;
  for (const auto& [reason, cells] : byReason) {
    std::string names;
    for (const std::string& name : namesOf(cells)) {
      if (!names.empty()) names += ", ";
      names += name;
    }
    notes.push_back("Not drawn: " + names + " (" + reason + ").");
  }
  return notes;
}

}  // namespace

Drawing frontDrawing(const Record& record, const WorkloadNote& workload) {
  const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
  Chart chart;
  setTitle(chart, workload.about);
  chart.about.push_back(kKey);
  chart.xName = "microseconds a query, in as many threads as suit the method (left is faster)";
  chart.yName = "worst error, sensor sizes (lower is better)";
  chart.floor = kErrorFloor;
  chart.floorName = print("%g or less, zero too", kErrorFloor);
  chart.missedName = "Some answers are wrong: contacts missed or invented, share of queries";
  chart.frontName = "the front: nothing is both faster and more right";
  chart.lines = linesOf(cells);
  for (const Cell* cell : frontOf(cells)) chart.front.push_back(pointOf(*cell));
  Drawing drawing{"front-" + workload.name, workload.about, {}, chart};
  drawing.notes.push_back(print("%u queries, %u with a contact.", cells.empty() ? 0 : cells[0]->queries,
                                cells.empty() ? 0 : cells[0]->contacts));
  for (const std::string& note : failureNotes(failedCells(record, "front", workload.name))) {
    drawing.notes.push_back(note);
  }
  return drawing;
}

Drawing table1Drawing(const Record& record) {
  Chart chart;
  const std::string caption = "The paper's Table 1: teapots among 10,000 to 30,000 boxes";
  setTitle(chart, caption);
  chart.about.push_back(
      "filled: Cyber Radar; hollow: other libraries; dashed: what the paper measured, on its machine");
  chart.xName = "boxes";
  chart.yName = "microseconds a query";
  chart.lines = timeLines(record, "table1", "boxes", false);
  ChartLine radar{.name = "the paper's Cyber Radar", .colour = 6, .dashed = true, .points = {}};
  ChartLine opcode{.name = "the paper's OPCODE", .colour = 6, .dashed = true, .points = {}};
  for (const PaperRow& row : paperTable1()) {
    radar.points.push_back({row.boxes, 1000 * row.cyberRadar, 0, "", ""});
    opcode.points.push_back({row.boxes, 1000 * row.opcode, 0, "", ""});
  }
  chart.lines.push_back(radar);
  chart.lines.push_back(opcode);
  return {
      "table1", caption, {"Dashed: what the paper measured on its machine, the first and last of its rows."}, chart};
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
    Chart chart;
    setTitle(chart, axis.title);
    chart.xName = axis.xName;
    chart.yName = "microseconds a query";
    chart.lines = timeLines(record, "growth", axis.name, true);
    if (chart.lines.empty()) continue;
    drawings.push_back({std::string("growth-") + axis.name, axis.title, {}, chart});
  }
  if (!record.workloads.empty()) {
    for (const Drawing& drawing : resolutionDrawings(record, record.workloads.front())) drawings.push_back(drawing);
  }
  for (Drawing& drawing : drawings) {
    drawing.chart.about.emplace_back(
        "filled: Cyber Radar; hollow: other libraries; in brackets: time grows as this power, by least squares of "
        "logarithms");
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
