#include "chart/drawings.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "batch/atomic_file.h"
#include "chart/findings.h"
#include "plot/plot.h"
#include "report/print.h"

namespace radar::tools {

namespace {

// Numbers of linetypes in plot/style.gp.
constexpr int kFirstOther = 6, kFront = 21, kPaperRadar = 22, kPaperOpcode = 23;

// A family has the same linetype in all charts of a record.
int linetypeOf(const Record& record, const std::string& family) {
  std::vector<std::string> others;
  for (const Cell& cell : record.cells) {
    const bool isNew = std::find(others.begin(), others.end(), cell.family) == others.end();
    if (!isOurs(cell.family) && isNew) others.push_back(cell.family);
  }
  const auto ours = std::find(kOurFamilies.begin(), kOurFamilies.end(), family);
  if (ours != kOurFamilies.end()) return 1 + static_cast<int>(ours - kOurFamilies.begin());
  return kFirstOther + static_cast<int>(std::find(others.begin(), others.end(), family) - others.begin());
}

// gnuplot has its own rules for quotation marks and backslashes in CSV files: fields are without.
std::string field(std::string text) {
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < ' ' || std::strchr("\",\\", c) != nullptr) c = ' ';
  }
  return text;
}

void addRow(Drawing& drawing, const std::string& name, int linetype, double x, double us) {
  drawing.rows += field(drawing.name) + "," + field(name) + print(",%d,,%g,%.6g,,\n", linetype, x, us);
}

void addFrontRow(Drawing& drawing, const std::string& name, int linetype, const Cell& cell) {
  drawing.rows +=
      field(drawing.name) + "," + field(name) +
      print(",%d,%u,,%.6g,%.6g,%.6g\n", linetype, cell.size, cell.us, 100 * wrongShare(cell), flooredError(cell));
}

Drawing frontDrawing(const Record& record, const WorkloadNote& workload) {
  const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
  Drawing drawing{"front-" + workload.name, workload.about, "", ""};
  for (const Cell* cell : cells) addFrontRow(drawing, cell->family, linetypeOf(record, cell->family), *cell);
  for (const Cell* cell : frontOf(cells)) addFrontRow(drawing, "front", kFront, *cell);
  return drawing;
}

void addTimes(Drawing& drawing, const Record& record, const std::string& section, const std::string& workload) {
  for (const auto& [first, times] : seriesOf(record, section, workload)) {
    for (const Point& point : times) {
      addRow(drawing, first->method, linetypeOf(record, first->family), point.x, point.y);
    }
  }
}

Drawing table1Drawing(const Record& record) {
  Drawing drawing{"table1", "The paper's Table 1: teapots among boxes", "boxes", ""};
  addTimes(drawing, record, "table1", "boxes");
  if (drawing.rows.empty()) return drawing;
  for (const PaperRow& row : paperTable1()) {
    addRow(drawing, "the paper's Cyber Radar", kPaperRadar, row.boxes, 1000 * row.cyberRadar);
  }
  for (const PaperRow& row : paperTable1()) {
    addRow(drawing, "the paper's OPCODE", kPaperOpcode, row.boxes, 1000 * row.opcode);
  }
  return drawing;
}

Drawing resolutionDrawing(const Record& record, const WorkloadNote& workload) {
  Drawing drawing{"growth-resolution", "Time against resolution: " + workload.about,
                  "pixels, or rays, of the longer side", ""};
  for (const Cell* cell : shownCells(record, "front", workload.name)) {
    if (cell->family != "sampled" && cell->family != "Embree rays") continue;
    addRow(drawing, cell->family, linetypeOf(record, cell->family), cell->size, cell->us);
  }
  return drawing;
}

}  // namespace

std::vector<Drawing> drawingsOf(const Record& record) {
  std::vector<Drawing> drawings;
  for (const WorkloadNote& workload : record.workloads) drawings.push_back(frontDrawing(record, workload));
  drawings.push_back(table1Drawing(record));
  for (const auto& [workload, title, xLabel] :
       {std::array{"boxes", "More of the scene: teapots among boxes at one density", "boxes"},
        std::array{"sensors", "Larger batches: boxes among 10,000 boxes", "sensors in the batch"},
        std::array{"triangles", "Finer meshes: rings among 200 rings", "triangles of each mesh"}}) {
    addTimes(drawings.emplace_back(Drawing{std::string("growth-") + workload, title, xLabel, ""}), record, "growth",
             workload);
  }
  if (!record.workloads.empty()) drawings.push_back(resolutionDrawing(record, record.workloads.front()));
  std::erase_if(drawings, [](const Drawing& drawing) { return drawing.rows.empty(); });
  return drawings;
}

void writeCharts(const std::filesystem::path& folder, const Record& record) {
  const std::vector<Drawing> drawings = drawingsOf(record);
  const std::filesystem::path points = folder / "points.csv";
  std::string rows = "chart,name,linetype,size,x,us,wrong_percent,worst_error\n";
  for (const Drawing& drawing : drawings) rows += drawing.rows;
  writeAtomically(points, rows);
  for (const Drawing& drawing : drawings) {
    std::string title = drawing.title;
    if (const size_t colon = title.find(": "); colon != std::string::npos) title.replace(colon, 2, "\n");
    const char* script = drawing.xLabel.empty() ? kFrontScript : kTimesScript;
    writeAtomically(folder / (drawing.name + ".svg"), plot(script, points, {drawing.name, title, drawing.xLabel}));
  }
}

}  // namespace radar::tools
