#include <algorithm>
#include <cmath>

#include "report/print.h"
#include "selftest/selftest.h"

namespace radar::tools {

namespace {

constexpr const char* kHead = R"(<!doctype html>
<html lang="en"><head><meta charset="utf-8"><title>Cyber Radar selftest</title><style>
body{max-width:1200px;margin:24px auto;padding:0 16px;font:16px/1.5 system-ui,sans-serif}
table{display:block;overflow-x:auto;border-collapse:collapse;font-size:.92rem;font-variant-numeric:tabular-nums}
th,td{padding:3px 14px 3px 4px;text-align:left;border-bottom:1px solid #ddd}
.bar{min-width:14em;background:linear-gradient(90deg,#9ecae9 var(--share),transparent var(--share))}
</style></head><body>
<h1>Cyber Radar: selftest</h1>
)";

std::string element(const char* tag, const std::string& text) {
  std::string escaped;
  for (const char c : text) escaped += c == '&' ? "&amp;" : c == '<' ? "&lt;" : std::string(1, c);
  return print("<%s>%s</%s>\n", tag, escaped.c_str(), tag);
}

std::string cell(const std::string& text) {
  return element("td", text);
}
std::string cell(uint64_t value) {
  return cell(grouped(static_cast<double>(value)));
}
// A number over a bar that fills the cell for `most`.
std::string barCell(const std::string& number, double value, double most) {
  return print("<td class=\"bar\" style=\"--share:%.1f%%\">%s</td>\n", 100 * value / most, number.c_str());
}

// `columns`: their names, with | between them. `cellsOf`: the cells of a row.
template <class Row, class CellsOf>
std::string table(const std::string& columns, const std::vector<Row>& rows, const CellsOf& cellsOf) {
  std::string text = "<table><tr><th>";
  for (const char c : columns) text += c == '|' ? "<th>" : std::string(1, c);
  for (const Row& row : rows) text += "<tr>\n" + cellsOf(row);
  return text + "</table>\n";
}

template <class Row>
double greatest(const std::vector<Row>& rows, double Row::*member) {
  double most = 0;
  for (const Row& row : rows) most = std::max(most, row.*member);
  return most;
}

std::string stagesTable(const std::vector<StageRow>& rows) {
  return table("workload|stage|microseconds per query", rows, [&](const StageRow& row) {
    return cell(row.workload) + cell(row.stage) + barCell(print("%.3f", row.us), row.us, greatest(rows, &StageRow::us));
  });
}

std::string lanesTable(const std::vector<LaneRow>& rows) {
  return table("way|microseconds per query|times as fast as the first", rows, [&](const LaneRow& row) {
    return cell(row.way) + cell(print("%.3f", row.us)) +
           barCell(print("%.2f", row.times), row.times, greatest(rows, &LaneRow::times));
  });
}

std::string throughputTable(const std::vector<ThroughputRow>& rows) {
  return table("workload|batch|device, queries a second|CPU, queries a second|device over CPU|answers that differ",
               rows, [&](const ThroughputRow& row) {
                 double fastest = 0;  // of the workload
                 for (const ThroughputRow& other : rows) {
                   if (other.workload == row.workload)
                     fastest = std::max({fastest, 1 / other.deviceUs, 1 / other.cpuUs});
                 }
                 const auto bar = [&](double us) { return barCell(grouped(1e6 / us), 1 / us, fastest); };
                 return cell(row.workload) + cell(row.batch) + bar(row.deviceUs) + bar(row.cpuUs) +
                        cell(print("%.2f", row.cpuUs / row.deviceUs)) + cell(row.differ);
               });
}

std::string deviceSection(const DeviceTest& device) {
  std::string text = element("h2", print("Device %u: ", device.number) + device.facts.name);
  text += element("pre", factsOf(device));
  if (!device.facts.usable()) return text;
  text += element("b", print("%llu answers compared with the CPU's, %llu wrong. ",
                             static_cast<unsigned long long>(device.checkedAnswers()),
                             static_cast<unsigned long long>(device.wrongAnswers())) +
                           (device.right() ? "Nothing is wrong here." : "Something is wrong here."));
  const auto section = [&](Part part, const std::string& title, const std::string& content) {
    const PartReport& report = device[part];
    text +=
        element("h3", title) + element("p", nameOf(report.state) + print(", %.1f s. ", report.seconds) + report.note);
    text += content;
  };
  section(Part::arithmetic, "Arithmetic, on which the bounds rest",
          table("operation|result|worst, ulp|found|needed|consequence", device.arithmetic,
                [](const ArithmeticCheck& check) {
                  return cell(check.operation) + cell(check.passed() ? "right" : "WRONG") +
                         cell(std::isnan(check.worst) ? "" : print("%.3g", check.worst)) + cell(check.found) +
                         cell(check.needed) + cell(check.consequence);
                }));
  section(Part::exactness, "Random queries of every family, compared with the CPU's answers",
          table("family|doubles|queries|hit|clear|overlap|wrong|pairs solved|of these by the CPU", device.exactness,
                [](const ExactnessRow& row) {
                  const Tally& t = row.tally;
                  return cell(row.family) + cell(row.doubles ? "with" : "without") + cell(t.queries) + cell(t.hits) +
                         cell(t.clear) + cell(t.overlaps) + cell(t.wrong) + cell(t.pairs) + cell(t.cpuPairs);
                }));
  section(Part::throughput, "Throughput of the device, and of all cores of the CPU",
          throughputTable(device.throughput));
  section(Part::stages, "Stages of mode contact, batches of 16,384", stagesTable(device.stages));
  section(Part::lanes, "Batches in flight", lanesTable(device.lanes));
  section(Part::passes, "Passes of mode sampled", stagesTable(device.passes));
  return text;
}

}  // namespace

std::string htmlOf(const SelftestReport& report) {
  std::string text =
      kHead + element("p", report.command + ", commit " + report.commit + ", " + report.date) +
      element("p", report.processor + print("; %.1f of %.1f minutes", report.seconds / 60, report.minutes));
  for (const DeviceTest& device : report.devices) text += deviceSection(device);
  if (!report.together.empty()) text += element("h2", "All devices together") + lanesTable(report.together);
  return text + "</body></html>\n";
}

}  // namespace radar::tools
