#include <algorithm>

#include "batch/whole_file.h"
#include "chart/drawings.h"
#include "chart/findings.h"
#include "chart/report.h"
#include "chart/tables.h"
#include "report/print.h"

namespace radar::tools {

namespace {

std::string listOf(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += "- " + sentence + "\n";
  return text + "\n";
}

std::string tableOf(const Table& table) {
  std::string text;
  for (size_t i = 0; i < table.size(); ++i) {
    text += "|";
    for (const std::string& cell : table[i]) text += " " + cell + " |";
    text += "\n";
    if (i > 0) continue;
    text += "|";
    for (size_t k = 0; k < table[0].size(); ++k) text += k == 0 ? "---|" : "--:|";
    text += "\n";
  }
  return text + "\n";
}

std::string originOf(const Record& record) {
  return "Measured " + record.date + ", commit " + record.commit + ", by\n\n    " + record.command + "\n\non " +
         record.machine + "; device: " + record.device + ". ";
}

std::string pictureOf(const Drawing& drawing, const std::string& charts) {
  std::string text = "![" + drawing.caption + "](" + charts + "/" + drawing.name + ".svg)\n\n*";
  for (const std::string& note : drawing.notes) text += (&note == &drawing.notes.front() ? "" : " ") + note;
  return drawing.notes.empty() ? text.substr(0, text.size() - 1) : text + "*\n\n";
}

// Least and greatest over the front's workloads of a number of a method's cells.
struct Spread {
  double least = INFINITY, most = -INFINITY;
  void take(double value) {
    if (std::isnan(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
};

template <class Number>
Spread spreadOf(const Record& record, const std::string& method, const Number& number) {
  Spread spread;
  for (const WorkloadNote& workload : record.workloads) {
    for (const Cell* cell : shownCells(record, "front", workload.name)) {
      if (cell->method == method) spread.take(number(*cell));
    }
  }
  return spread;
}

std::string timesOf(const Record& record, const std::string& method) {
  const Spread us = spreadOf(record, method, [](const Cell& cell) { return cell.us; });
  return inWords(us.least) + " to " + inWords(us.most) + " us a query";
}

// On how many workloads, and on which, mode contact is on the front beside methods that sample.
std::string frontsOf(const Record& record) {
  std::string on;
  size_t number = 0;
  for (const WorkloadNote& workload : record.workloads) {
    const BesideSampling beside = besideSampling(shownCells(record, "front", workload.name));
    if (beside.contact == nullptr || beside.better != nullptr) continue;
    ++number;
    on += (on.empty() ? "" : ", ") + workload.name;
  }
  return print("%zu of %zu workloads", number, record.workloads.size()) + (number > 0 ? " (" + on + ")." : ".") +
         (number < record.workloads.size()
              ? " Elsewhere such a method takes less time and happens to answer these queries without a miss, but "
                "certifies none of them; by how much stands under each chart."
              : "");
}

// Mode by mode, with the run's numbers: of what it measured.
std::vector<std::string> adviceOf(const Record& record) {
  const auto worst = [](const Cell& cell) { return cell.errorWorst; };
  const auto missed = [](const Cell& cell) { return 100 * wrongShare(cell); };
  std::vector<std::string> advice;
  advice.push_back("**A distance to rely upon: mode `contact`**, the default. " + timesOf(record, "contact") +
                   print("; worst error over all workloads %.2g of the sensor's size. Use it for time of impact, "
                         "placement, clearance.",
                         spreadOf(record, "contact", worst).most));
  advice.push_back(
      "**The paper's method: mode `sampled`**. At 64 pixels " + timesOf(record, "sampled 64") +
      print(
          "; up to %.1f%% of its answers on a workload miss a contact, at 256 pixels up to %.1f%%. Use it to see what "
          "the paper's method sees.",
          spreadOf(record, "sampled 64", missed).most, spreadOf(record, "sampled 256", missed).most));
  advice.push_back("**No device: mode `reference`**. " + timesOf(record, "reference") +
                   ", the exact search on the CPU. Mode `contact` takes it, too, where the device itself runs on the "
                   "CPU; *contact on device* is the device's own search.");
  advice.push_back(
      "**Beside methods that sample** (pixels of mode sampled, rays of Embree, steps of FCL and ODE), mode `contact` "
      "is on the front on " +
      frontsOf(record));
  return advice;
}

}  // namespace

std::string accuracyDocument(const Record& record, const std::string& charts) {
  std::string text = "# Accuracy\n\nHow right each method is, on the same queries, against the exact answers. " +
                     originOf(record) + "The numbers: [CSV](" + charts + "/chart.csv), [JSON](" + charts +
                     "/chart.json); all charts on one page: [chart.html](" + charts +
                     "/chart.html). This file is made from them, anew by the same command with `--render`.\n\n";
  text +=
      "Lengths are in sizes of the sensor, the greatest extent of its box. An answer is *missed* if there is a contact "
      "and the method tells none, or sees none; a *false hit* if it tells one where there is none. " +
      std::string(kFrontInWords) +
      " Running the command again gives the same columns to the last digit, on the same driver.\n\n## Which mode for "
      "what\n\n" +
      listOf(adviceOf(record));
  for (const WorkloadNote& workload : record.workloads) {
    text += "## " + workload.name + "\n\n" + workload.about + ".\n\n" +
            pictureOf(frontDrawing(record, workload), charts) + listOf(frontFindings(record, workload.name)) +
            tableOf(accuracyTable(record, workload.name));
  }
  if (!record.notes.empty()) text += "## What the others cannot do\n\n" + listOf(record.notes);
  return text;
}

std::string speedDocument(const Record& record, const std::string& charts) {
  std::string text = "# Speed\n\nHow long each method takes, on the same queries. " + originOf(record) +
                     "The numbers: [CSV](" + charts +
                     "/chart.csv). How right the answers are: [accuracy](accuracy.md).\n\n"
                     "A time is that of a batch divided by its queries: the median over passes, and quartiles. "
                     "*Processor us* adds up all threads. Preparing (trees, uploads) and changes of scene are apart. A "
                     "software device takes all threads of the processor.\n\n";
  if (!shownCells(record, "table1", "boxes").empty()) {
    text += "## The paper's Table 1\n\n" + pictureOf(table1Drawing(record), charts) + listOf(table1Findings(record)) +
            tableOf(table1Table(record));
  }
  text += "## As the work grows\n\n";
  for (const Drawing& drawing : growthDrawings(record)) text += pictureOf(drawing, charts);
  text += listOf(growthFindings(record));
  for (const char* axis : {"boxes", "sensors", "triangles"}) {
    if (const Table table = growthTable(record, axis); table.size() > 1) text += tableOf(table);
  }
  for (const WorkloadNote& workload : record.workloads) {
    text += "## " + workload.name + "\n\n" + workload.about + ". Chart: [accuracy](accuracy.md#" + workload.name +
            ").\n\n" + tableOf(speedTable(record, workload.name));
  }
  return text;
}

void writeDocuments(const std::filesystem::path& folder, const std::filesystem::path& charts, const Record& record) {
  const std::string place = std::filesystem::relative(charts, folder).generic_string();
  writeWhole(folder / "accuracy.md", accuracyDocument(record, place));
  writeWhole(folder / "speed.md", speedDocument(record, place));
}

}  // namespace radar::tools
