#include "chart/documents.h"

#include <algorithm>
#include <map>

#include "batch/atomic_file.h"
#include "chart/drawings.h"
#include "chart/findings.h"
#include "report/print.h"

namespace radar::tools {

namespace {

std::string listOf(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += "- " + sentence + "\n";
  return text + "\n";
}

// A heading line, then lines of cells.
using Table = std::vector<std::vector<std::string>>;

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
  return "Measured on " + record.date + ", commit " + record.commit + ", with\n\n    " + record.command + "\n\non " +
         record.machine + ", device " + record.device +
         ". The same command with `--render` writes this page again from what it measured.\n\n";
}

std::string pictureOf(const Drawing& drawing, const std::string& charts) {
  return "![" + drawing.title.substr(0, drawing.title.find(": ")) + "](" + charts + "/" + drawing.name + ".svg)\n\n";
}

// Methods without numbers, by reason.
std::string failuresOf(const Record& record, const WorkloadNote& workload) {
  std::map<std::string, std::vector<std::string>> methods;
  for (const Cell& cell : record.cells) {
    if (cell.section != "front" || cell.workload != workload.name || cell.failed.empty()) continue;
    std::vector<std::string>& names = methods[cell.failed];
    if (names.empty() || names.back() != cell.method) names.push_back(cell.method);
  }
  std::string text;
  for (const auto& [reason, names] : methods) {
    text += " Not drawn: ";
    for (const std::string& name : names) text += (&name == &names.front() ? "" : ", ") + name;
    text += " (" + reason + ").";
  }
  return text;
}

// Least and greatest of the numbers taken.
struct Spread {
  double least = INFINITY, most = -INFINITY;
  void take(double value) {
    if (std::isnan(value)) return;
    least = std::min(least, value);
    most = std::max(most, value);
  }
  bool isEmpty() const { return least > most; }
};

// A method over all workloads of the front.
struct Summary {
  uint64_t queries = 0, wrong = 0;
  Spread us, wrongShare, error;
  std::vector<std::string> without;  // workloads on which it has no numbers

  bool wasMeasured() const { return queries > 0; }
  std::string times() const { return inWords(us.least) + " to " + timeInWords(us.most) + " per query"; }
};

Summary summaryOf(const Record& record, const std::string& method) {
  Summary summary;
  for (const WorkloadNote& workload : record.workloads) {
    const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
    const auto found =
        std::find_if(cells.begin(), cells.end(), [&](const Cell* cell) { return cell->method == method; });
    if (found == cells.end()) {
      summary.without.push_back(workload.name);
      continue;
    }
    const Cell& cell = **found;
    summary.queries += cell.queries;
    summary.wrong += cell.misses + cell.falseHits;
    summary.us.take(cell.us);
    summary.wrongShare.take(100 * wrongShare(cell));
    summary.error.take(cell.errorWorst);
  }
  return summary;
}

// Of each family the member with the most pixels, rays or steps, in the order of the record.
std::vector<std::string> finestMethods(const Record& record) {
  std::vector<const Cell*> finest;
  for (const Cell& cell : record.cells) {
    if (cell.section != "front" || !cell.failed.empty()) continue;
    const auto same =
        std::find_if(finest.begin(), finest.end(), [&](const Cell* one) { return one->family == cell.family; });
    if (same == finest.end()) {
      finest.push_back(&cell);
    } else if (cell.size > (*same)->size) {
      *same = &cell;
    }
  }
  std::vector<std::string> methods;
  methods.reserve(finest.size());
  for (const Cell* cell : finest) methods.push_back(cell->method);
  return methods;
}

Table summaryTable(const Record& record) {
  Table table{{"method", "wrong answers", "on the worst workload", "worst error", "µs per query"}};
  for (const std::string& method : finestMethods(record)) {
    const Summary summary = summaryOf(record, method);
    std::string name = method;
    for (const std::string& workload : summary.without) name += " (fails on " + workload + ")";
    table.push_back({name, print("%.1f%%", 100 * double(summary.wrong) / double(summary.queries)),
                     print("%.1f%%", summary.wrongShare.most),
                     summary.error.isEmpty() ? "-" : print("%.2g", summary.error.most),
                     inWords(summary.us.least) + " to " + inWords(summary.us.most)});
  }
  return table;
}

// On how many workloads mode contact is on the front beside methods that sample, and on which it is not.
std::string frontsOf(const Record& record) {
  std::string off;
  size_t number = 0;
  for (const WorkloadNote& workload : record.workloads) {
    if (isContactOnFrontBesideSampling(shownCells(record, "front", workload.name))) {
      ++number;
    } else {
      off += (off.empty() ? "" : ", ") + workload.name;
    }
  }
  return print(
             "Compared only with the methods that sample pixels, rays or steps of the motion, mode contact is on the "
             "front on %zu of %zu workloads",
             number, record.workloads.size()) +
         (off.empty() ? "." : ", not on " + off + ".");
}

std::string captionOf(const Record& record, const WorkloadNote& workload) {
  const std::vector<const Cell*> cells = shownCells(record, "front", workload.name);
  const uint32_t queries = cells.empty() ? 0 : cells[0]->queries, contacts = cells.empty() ? 0 : cells[0]->contacts;
  return "*" + workload.name + print(": %u queries, %u with a contact.", queries, contacts) +
         failuresOf(record, workload) + " " + fastestRight(record, workload.name) + "*\n\n";
}

// Mode by mode, with the run's numbers: of what it measured.
std::vector<std::string> adviceOf(const Record& record) {
  std::vector<std::string> advice;
  if (const Summary contact = summaryOf(record, "contact"); contact.wasMeasured()) {
    advice.push_back(
        "**Mode `contact`, the default**, gives certified distances, for times of impact, placement and clearance. It "
        "took " +
        contact.times() + print("; its worst error was %.2g.", contact.error.isEmpty() ? 0.0 : contact.error.most));
  }
  if (const Summary coarse = summaryOf(record, "sampled 64"); coarse.wasMeasured()) {
    std::string text = "**Mode `sampled`** shows what the paper's method sees. With 64 pixels it took " +
                       coarse.times() +
                       print("; up to %.1f%% of its answers on a workload were wrong", coarse.wrongShare.most);
    const Summary fine = summaryOf(record, "sampled 256");
    if (fine.wasMeasured()) text += print(", with 256 pixels up to %.1f%%", fine.wrongShare.most);
    advice.push_back(text + ".");
  }
  if (const Summary reference = summaryOf(record, "reference"); reference.wasMeasured()) {
    advice.push_back("**Mode `reference`** is the exact search on the CPU and needs no device. It took " +
                     reference.times() +
                     ". Where the device itself runs on the CPU, mode `contact` uses the same search; *contact on "
                     "device* is the device's own.");
  }
  return advice;
}

// The methods over the workloads' names: microseconds a query, and the fastest other library without a wrong answer.
Table workloadTable(const Record& record) {
  const std::vector<std::string> ours{"contact", "contact on device", "reference", "sampled 64"};
  Table table{{"µs per query"}};
  table[0].insert(table[0].end(), ours.begin(), ours.end());
  table[0].emplace_back("fastest other library without a wrong answer");
  for (const WorkloadNote& workload : record.workloads) {
    std::map<std::string, double> us;
    const Cell* other = nullptr;
    for (const Cell* cell : shownCells(record, "front", workload.name)) {
      us[cell->method] = cell->us;
      if (isOurs(cell->family) || wrongShare(*cell) > 0) continue;
      if (other == nullptr || cell->us < other->us) other = cell;
    }
    std::vector<std::string>& line = table.emplace_back(std::vector<std::string>{workload.name});
    for (const std::string& method : ours) line.push_back(us.contains(method) ? inWords(us[method]) : "-");
    line.push_back(other == nullptr ? "none" : inWords(other->us) + " (" + other->method + ")");
  }
  return table;
}

// The times of the paper's Table 1 at both ends, the paper's own last.
Table table1Table(const Record& record) {
  const std::vector<Point> contact = contactTimes(record, "table1", "boxes");
  if (contact.size() < 2) return {};
  Table table{
      {"µs per query among", grouped(contact.front().x) + " boxes", grouped(contact.back().x) + " boxes", "ratio"}};
  const auto add = [&](const std::string& name, double few, double many) {
    table.push_back({name, inWords(few), inWords(many), print("%.2f", many / few)});
  };
  for (const auto& [first, times] : seriesOf(record, "table1", "boxes")) {
    if (times.size() == contact.size()) add(first->method, times.front().y, times.back().y);
  }
  const PaperRow &few = paperTable1().front(), &many = paperTable1().back();
  if (few.boxes == contact.front().x && many.boxes == contact.back().x) {
    add("the paper's Cyber Radar", 1000 * few.cyberRadar, 1000 * many.cyberRadar);
    add("the paper's OPCODE", 1000 * few.opcode, 1000 * many.opcode);
  }
  return table;
}

}  // namespace

std::string accuracyDocument(const Record& record, const std::string& charts) {
  std::string text =
      "# Accuracy\n\nEvery method answers the same queries, and each answer is compared with the exact one. " +
      originOf(record) + "[chart.csv](" + charts +
      "/chart.csv) has all numbers, and [performance](performance.md) explains the times.\n\nLengths are in units of "
      "the sensor's size, the longest side of its box. An answer is *wrong* if it misses a contact, by denying it or "
      "by not seeing it, or reports one that does not exist. *Error* is the error of the distances found. Accuracy "
      "does "
      "not vary from run to run on the same driver.\n\n";
  text += "## Which mode for what\n\n" + listOf(adviceOf(record));
  text += "## All workloads\n\n" + tableOf(summaryTable(record)) +
          "*Methods with sizes are shown with their largest. Times run from the fastest workload to the slowest.*\n\n";
  text += "## Accuracy against speed\n\n" + std::string(kFrontInWords) + " " + frontsOf(record) + "\n\n";
  const std::vector<Drawing> drawings = drawingsOf(record);
  for (const WorkloadNote& workload : record.workloads) {
    for (const Drawing& drawing : drawings) {
      if (drawing.name == "front-" + workload.name) text += pictureOf(drawing, charts);
    }
    text += captionOf(record, workload);
  }
  if (!record.notes.empty()) text += "## What the other libraries cannot do\n\n" + listOf(record.notes);
  text.pop_back();  // the empty line at the end
  return text;
}

std::string performanceDocument(const Record& record, const std::string& charts) {
  std::string text = "# Performance\n\nEvery method answers the same queries. " + originOf(record) +
                     "A time is that of a whole batch divided by its queries: the median over passes, with the number "
                     "of threads that was fastest. [chart.csv](" +
                     charts +
                     "/chart.csv) has the quartiles, the processor times, the times to prepare and to change scenes, "
                     "and every number of threads. [Accuracy](accuracy.md) says how right the answers are, "
                     "[benchmarks](benchmarks.md) how the exact searches compare by batch size, and "
                     "[scaling](scaling.md) what several devices gain.\n\n";
  text += "## Workload by workload\n\n" + tableOf(workloadTable(record));
  std::string table1, growth;
  for (const Drawing& drawing : drawingsOf(record)) {
    if (drawing.name == "table1") table1 += pictureOf(drawing, charts);
    if (drawing.name.starts_with("growth-")) growth += pictureOf(drawing, charts);
  }
  if (const Table table = table1Table(record); !table.empty()) {
    text += "## The paper's Table 1\n\n" + table1 + tableOf(table) + listOf(table1Findings(record));
  }
  if (!growth.empty()) text += "## As the work grows\n\n" + growth + listOf(growthFindings(record));
  text.pop_back();  // the empty line at the end
  return text;
}

void writeDocuments(const std::filesystem::path& folder, const std::filesystem::path& charts, const Record& record) {
  const std::string place = std::filesystem::relative(charts, folder).generic_string();
  writeAtomically(folder / "accuracy.md", accuracyDocument(record, place));
  writeAtomically(folder / "performance.md", performanceDocument(record, place));
}

}  // namespace radar::tools
