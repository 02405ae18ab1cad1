#include "report/page.h"

#include <algorithm>
#include <cmath>

#include "report/axis.h"
#include "report/markup.h"
#include "report/plain_chart.h"
#include "report/print.h"
#include "selftest/selftest.h"

namespace radar::tools {

namespace {

std::string paragraph(const std::string& text, const char* style = "") {
  return std::string("<p") + (*style != '\0' ? std::string(" class=\"") + style + "\"" : "") + ">" + escaped(text) +
         "</p>\n";
}

std::string heading(const DeviceTest& device, Part part, const std::string& title) {
  const PartReport& report = device[part];
  std::string text = "<h3>" + escaped(title) + "</h3>\n";
  std::string state = nameOf(report.state);
  if (!report.note.empty()) state += ": " + report.note;
  if (report.seconds > 0) state += print(", %.1f s", report.seconds);
  return text + paragraph(state, "soft");
}

std::string whole(uint64_t value) {
  return value == 0 ? "0" : inTic(static_cast<double>(value));
}

std::string limitsTable(const DeviceTest& device) {
  std::string text = openTable() + row({"limit", "has", "needed", "for mode"}, "th");
  for (const DeviceLimit& limit : device.facts.limits) {
    text += row({escaped(limit.name), whole(limit.has), whole(limit.needed),
                 limit.mode == Mode::contact ? "contact" : "sampled"});
  }
  return "<details><summary>Limits that shaders rely on</summary>\n" + text + closeTable() + "</details>\n";
}

// A cell of words, which may be broken.
std::string words(const std::string& text) {
  return "<div style=\"min-width:11em;text-align:left;white-space:normal\">" + escaped(text) + "</div>";
}

std::string arithmeticTable(const DeviceTest& device) {
  std::string text =
      openTable() + row({"operation", "", "worst, ulp", words("found"), words("needed"), words("so")}, "th");
  for (const ArithmeticCheck& check : device.arithmetic) {
    text += row({words(check.operation), check.passed() ? "right" : "<b>WRONG</b>",
                 std::isnan(check.worst) ? "" : print("%.3g", check.worst), words(check.found), words(check.needed),
                 words(check.consequence)});
  }
  return text + closeTable();
}

std::string exactnessTable(const DeviceTest& device) {
  std::string text = openTable() + row({"family", "doubles", "queries", "hit", "clear", "overlap", "wrong",
                                        "pairs solved", "of these by the CPU"},
                                       "th");
  for (const ExactnessRow& one : device.exactness) {
    const RandomTally& t = one.tally;
    text += row({escaped(one.family), one.doubles ? "with" : "without", whole(t.queries), whole(t.hits), whole(t.clear),
                 whole(t.overlaps), t.wrong == 0 ? "0" : "<b>" + whole(t.wrong) + "</b>", whole(t.pairs),
                 whole(t.cpuPairs)});
  }
  return text + closeTable();
}

Chart chartOf(const DeviceTest& device, const std::string& workload, const std::string& title) {
  Chart chart;
  chart.title = title;
  chart.xName = "queries in a batch";
  chart.yName = "queries a second";
  chart.width = 560;
  chart.height = 380;
  ChartLine onDevice{.name = "device", .colour = 0}, onCpu{.name = "CPU", .colour = 1};
  for (const ThroughputRow& row : device.throughput) {
    if (row.workload != workload) continue;
    const auto batch = static_cast<double>(row.batch);
    const auto add = [&](ChartLine& line, double us) {
      line.points.push_back({batch, 1e6 / us, 0, "", print("%s: %.3g us a query", line.name.c_str(), us)});
    };
    add(onDevice, row.deviceUs);
    add(onCpu, row.cpuUs);
  }
  chart.lines = {onDevice, onCpu};
  return chart;
}

std::string throughputCharts(const DeviceTest& device) {
  return "<div class=\"charts\">\n" +
         figure(plainSvg(chartOf(device, "light", "Light: small boxes among 30,000 boxes"))) +
         figure(plainSvg(chartOf(device, "heavy", "Heavy: teapots of 6,320 triangles among 10,000 boxes"))) +
         figure(plainSvg(chartOf(device, "moving", "Moving: all sensors fly on between batches"))) + "</div>\n";
}

std::string throughputTable(const DeviceTest& device) {
  std::string text = openTable() + row({"workload", "batch", "device, us a query", "CPU, us a query",
                                        "device as fast as the CPU, times", "answers that differ"},
                                       "th");
  for (const ThroughputRow& one : device.throughput) {
    text += row({escaped(one.workload), whole(one.batch), print("%.3f", one.deviceUs), print("%.3f", one.cpuUs),
                 print("%.2f", one.cpuUs / one.deviceUs), one.differ == 0 ? "0" : "<b>" + whole(one.differ) + "</b>"});
  }
  return text + closeTable();
}

// A bar for each stage, of the time that the caller sees.
std::string stagesTable(const std::vector<StageRow>& rows) {
  double most = 0;
  for (const StageRow& one : rows) most = std::max(most, one.us);
  std::string text = openTable() + row({"workload", "stage", "us a query", ""}, "th");
  for (const StageRow& one : rows) {
    const std::string bar =
        print("<div style=\"width:%.1fpx;height:12px;background:var(--c0)\"></div>", 260 * one.us / most);
    text += row({escaped(one.workload), escaped(one.stage), print("%.3f", one.us), bar});
  }
  return text + closeTable();
}

std::string lanesTable(const std::vector<LaneRow>& rows) {
  std::string text = openTable() + row({"way", "us a query", "times as fast as the first"}, "th");
  for (const LaneRow& one : rows) text += row({escaped(one.way), print("%.3f", one.us), print("%.2f", one.times)});
  return text + closeTable();
}

std::string deviceSection(const DeviceTest& device) {
  const DeviceReport& facts = device.facts;
  std::string text = "<h2>" + escaped(print("Device %u: ", device.number) + facts.name) + "</h2>\n";
  text += paragraph(
      facts.type + ", driver " + facts.driver + ", Vulkan " + facts.version +
      print(", %.1f GiB of its own, subgroups of %u, ", static_cast<double>(facts.memory) / (1 << 30), facts.subgroup) +
      (!facts.doubles       ? "no doubles"
       : device.usesDoubles ? "doubles, which are used"
                            : "doubles, which are not used"));
  for (const std::string& reason : facts.reasons) text += paragraph("Not usable: " + reason);
  for (const std::string& reason : facts.sampledReasons) text += paragraph("No mode sampled: " + reason);
  if (!facts.usable()) return text;
  text += "<p><b>" + whole(device.checkedAnswers()) + " answers held against the CPU's, " +
          whole(device.wrongAnswers()) + " wrong" + (device.right() ? "" : ". Something is wrong here") + ".</b></p>\n";
  text += limitsTable(device);
  text += heading(device, Part::arithmetic, "Arithmetic: what the bounds rest on") + arithmeticTable(device);
  text +=
      heading(device, Part::exactness, "Exactness: random queries of every family, held against the CPU's answers") +
      exactnessTable(device);
  text += heading(device, Part::throughput,
                  "Throughput: the device's search, and the exact search on all cores of the CPU") +
          throughputCharts(device) + throughputTable(device);
  text += heading(device, Part::stages, "Where the time goes: the exact search, batches of 16,384") +
          stagesTable(device.stages);
  text += heading(device, Part::lanes, "Batches in flight") + lanesTable(device.lanes);
  text += heading(device, Part::passes, "The paper's passes: mode sampled, where the time goes") +
          stagesTable(device.passes);
  return text;
}

}  // namespace

std::string htmlOf(const SelftestReport& report) {
  std::string text = openPage("Cyber Radar selftest", "Cyber Radar: selftest");
  text += paragraph(report.command + ", commit " + report.commit + ", " + report.date, "soft");
  text += paragraph(report.processor + print("; %.1f of %.1f minutes", report.seconds / 60, report.minutes), "soft");
  for (const DeviceTest& device : report.devices) text += deviceSection(device);
  if (!report.together.empty()) {
    text += "<h2>All devices together</h2>\n" + lanesTable(report.together);
  }
  return text + closePage();
}

}  // namespace radar::tools
