#include "report/page.h"
#include "batch/atomic_file.h"
#include "chart/drawings.h"
#include "chart/findings.h"
#include "chart/report.h"
#include "report/chart.h"
#include "report/markup.h"

namespace radar::tools {

namespace {

std::string listOf(const std::vector<std::string>& sentences) {
  std::string text = "<ul class=\"findings\">\n";
  for (const std::string& sentence : sentences) text += "<li>" + escaped(sentence) + "</li>\n";
  return text + "</ul>\n";
}

// What stands above every chart: where it comes from.
std::string figureOf(const Record& record, const Drawing& drawing) {
  std::vector<std::string> notes = drawing.notes;
  notes.push_back(record.command + "; " + record.machine + "; " + record.device + "; commit " + record.commit + "; " +
                  record.date);
  return figure(inlineSvg(drawing.chart, drawing.name), notes);
}

std::string frontsOf(const Record& record) {
  std::string text;
  for (const WorkloadNote& workload : record.workloads) {
    text += "<h2>" + escaped(workload.name) + "</h2>\n<div class=\"charts large\">\n" +
            figureOf(record, frontDrawing(record, workload)) + "<div>" + listOf(frontFindings(record, workload.name)) +
            "</div></div>\n";
  }
  return text;
}

}  // namespace

std::string pageOf(const Record& record) {
  std::string html = openPage("Cyber Radar: accuracy against speed", "Accuracy against speed");
  html +=
      "<p>How far can a shape move before it first touches anything? Every method answers the same queries, and each "
      "answer is compared with the exact one. Lengths are in units of the sensor's size, the longest side of its "
      "box. " +
      std::string(kFrontInWords) +
      "</p>\n"
      "<p class=\"soft\">" +
      escaped(record.date) + ", commit " + escaped(record.commit) + "; " + escaped(record.machine) + "; " +
      escaped(record.device) + "</p>\n<p class=\"soft\"><code>" + escaped(record.command) + "</code></p>\n";
  html += frontsOf(record);
  if (!shownCells(record, "table1", "boxes").empty()) {
    html += "<h2>The paper's Table 1</h2>\n<div class=\"charts large\">\n" + figureOf(record, table1Drawing(record)) +
            "<div>" + listOf(table1Findings(record)) + "</div></div>\n";
  }
  html += "<h2>As the work grows</h2>\n<div class=\"charts large\">\n";
  for (const Drawing& drawing : growthDrawings(record)) html += figureOf(record, drawing);
  html += "</div>\n" + listOf(growthFindings(record));
  if (!record.notes.empty()) html += "<h2>What the other libraries cannot do</h2>\n" + listOf(record.notes);
  return html + closePage();
}

void writeReport(const std::filesystem::path& folder, const Record& record) {
  writeAtomically(folder / "chart.html", pageOf(record));
  for (const Drawing& drawing : drawingsOf(record)) {
    writeAtomically(folder / (drawing.name + ".svg"), svgFile(drawing.chart));
    writeAtomically(folder / (drawing.name + ".png"), pngFile(drawing.chart));
  }
}

}  // namespace radar::tools
