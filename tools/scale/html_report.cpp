#include <algorithm>

#include "report/chart.h"
#include "report/markup.h"
#include "report/page.h"
#include "report/print.h"
#include "report/timeline.h"
#include "scale/findings.h"
#include "scale/report.h"

namespace radar::tools {

namespace {

std::string countName(size_t count) {
  return std::to_string(count) + (count == 1 ? " device" : " devices");
}

std::string setName(const ScaleReport& report, const ScaleRun& run) {
  std::string text = run.devices.size() == 1 ? "device" : "devices";
  for (size_t i = 0; i < run.devices.size(); ++i) {
    text += (i == 0 ? " " : " + ") + std::to_string(report.numbers[run.devices[i]]);
  }
  return text;
}

// Over sensors, from 0 up.
Chart chartOf(const std::string& title, const std::string& yName) {
  Chart chart;
  chart.title = title;
  chart.xName = "sensors";
  chart.yName = yName;
  chart.width = 560;
  chart.height = 430;
  chart.logarithmic = false;
  return chart;
}

template <class Value>
ChartLine lineOf(const ScaleReport& report, const std::string& name, Value value) {
  ChartLine line;
  line.name = name;
  for (size_t p = 0; p < report.sensors.size(); ++p) line.points.push_back({report.sensors[p], value(p), 0, "", ""});
  return line;
}

// The value of each count of devices.
template <class Value>
void addLines(Chart& chart, const ScaleReport& report, size_t from, Value value) {
  for (size_t count = from; count <= report.devices.size(); ++count) {
    ChartLine line = lineOf(report, countName(count), [&](size_t p) { return value(report.run(p, count)); });
    line.colour = static_cast<int>(count - 1) % 6;
    line.mark = static_cast<Mark>((count - 1) % 4);
    chart.lines.push_back(line);
  }
}

template <class Value>
void addIdeal(Chart& chart, const ScaleReport& report, const std::string& name, Value value) {
  chart.lines.push_back(lineOf(report, name, value));
  chart.lines.back().dashed = true;
  chart.lines.back().colour = 6;
}

std::string charts(const ScaleReport& report) {
  const auto perBatch = [&](const ScaleRun& run) { return run.ms / static_cast<double>(report.batches[run.point]); };
  const size_t count = report.devices.size();
  Chart times = chartOf("Time of a batch (the paper's Figure 7)", "ms a batch");
  addLines(times, report, 1, perBatch);
  if (count > 1) {
    addIdeal(times, report, count > 2 ? "1 / " + std::to_string(count) : "half of 1",
             [&](size_t p) { return perBatch(report.run(p, 1)) / static_cast<double>(count); });
  }
  std::string text = "<div class=\"charts\">\n" + figure(inlineSvg(times, "times"));
  if (count > 1) {
    Chart speedUps = chartOf("Speed-up against the first device alone", "times as fast");
    addLines(speedUps, report, 2, [&](const ScaleRun& run) { return report.speedUp(run); });
    addIdeal(speedUps, report, "ideal", [&](size_t) { return static_cast<double>(count); });
    Chart efficiencies = chartOf("Efficiency: share of what the devices can do together", "%");
    addLines(efficiencies, report, 2, [&](const ScaleRun& run) { return 100 * report.efficiency(run); });
    addIdeal(efficiencies, report, "ideal", [](size_t) { return 100.0; });
    text += figure(inlineSvg(speedUps, "speed-ups")) + figure(inlineSvg(efficiencies, "efficiencies"));
  }
  return text + "</div>\n";
}

// A few batches from the middle, so that chunks can be seen.
std::string timelineOf(const ScaleReport& report, const ScaleRun& run) {
  constexpr size_t kBatches = 3;
  const size_t shown = std::min(kBatches, run.batches.size()), first = (run.batches.size() - shown) / 2;
  const double from = run.batches[first].submitted, to = run.batches[first + shown - 1].answered;
  std::vector<Track> tracks;
  for (const uint32_t device : run.devices) {
    const std::string number = std::to_string(report.numbers[device]);
    tracks.push_back({"device " + number, {}});
    tracks.push_back({"its thread", {}});
  }
  std::vector<double> free(run.devices.size(), from);
  for (size_t b = first; b < first + shown; ++b) {
    for (const ChunkTrace& chunk : run.batches[b].chunks) {
      const auto add = [&](size_t track, double begin, double end, int colour, const char* what) {
        if (end <= begin) return;
        tracks[track].bars.push_back(
            {begin, end, colour, print("%s, %u queries, %.3f ms", what, chunk.queries, end - begin)});
      };
      const size_t track = 2 * size_t{chunk.device};
      add(track, std::max(chunk.submitted, free[chunk.device]), chunk.done, 0, "with the device");
      free[chunk.device] = std::max(free[chunk.device], chunk.done);
      add(track + 1, chunk.begun, chunk.submitted, 1, "encode and submit");
      add(track + 1, chunk.awaited, chunk.done, 5, "wait");
      add(track + 1, std::max(chunk.done, chunk.awaited), chunk.decoded, 2, "decode");
    }
  }
  const std::string title =
      setName(report, run) + print(", batches %zu to %zu of %zu", first + 1, first + shown, run.batches.size());
  return "<h3>" + escaped(title) + "</h3><div class=\"scroll\">" + timeline(title, from, to, tracks) + "</div>\n";
}

std::string runsTable(const ScaleReport& report) {
  std::string text =
      openTable() +
      row({"devices", "sensors", "ms a batch", "range", "speed-up", "efficiency", "processor cores in use"}, "th");
  for (const ScaleRun& run : report.runs) {
    const auto batches = static_cast<double>(report.batches[run.point]);
    text += row({setName(report, run), print("%g", report.sensors[run.point]), print("%.3f", run.ms / batches),
                 print("%.3f to %.3f", run.least / batches, run.most / batches), print("%.2f", report.speedUp(run)),
                 print("%.0f%%", 100 * report.efficiency(run)), print("%.2f", run.cores)});
  }
  return text + closeTable();
}

std::string sharesTable(const ScaleReport& report, size_t point) {
  std::string text =
      openTable() + row({"set", "device", "busy", "idle: first chunk", "between chunks", "at the end", "queries",
                         "chunks", "chunk sizes", "encode and submit, ms", "wait, ms", "decode, ms"},
                        "th");
  for (const ScaleRun& run : report.runs) {
    if (run.point != point) continue;
    for (size_t i = 0; i < run.shares.size(); ++i) {
      const DeviceShare& share = run.shares[i];
      const auto percent = [&](double ms) { return print("%.1f%%", 100 * ms / run.ms); };
      text += row({setName(report, run), std::to_string(report.numbers[run.devices[i]]), percent(share.busy),
                   percent(share.start), percent(share.gap), percent(share.tail), std::to_string(share.queries),
                   std::to_string(share.chunks), print("%u to %u", share.leastChunk, share.mostChunk),
                   print("%.2f", share.encode), print("%.2f", share.wait), print("%.2f", share.decode)});
    }
  }
  return text + closeTable();
}

std::string lossesTable(const ScaleReport& report, size_t point) {
  std::string text =
      openTable() +
      row({"set", "useful", "slower than alone", "first chunk", "between chunks", "imbalance", "scene edits"}, "th");
  for (size_t count = 1; count <= report.devices.size(); ++count) {
    const ScaleRun& run = report.run(point, count);
    const Losses losses = lossesOf(report, run);
    const auto percent = [](double share) { return print("%.1f%%", 100 * share); };
    text += row({setName(report, run), percent(losses.useful), percent(losses.slower), percent(losses.start),
                 percent(losses.gap), percent(losses.tail), percent(losses.scene)});
  }
  return text + closeTable();
}

std::string stagesTable(const ScaleReport& report, size_t point) {
  std::string text = openTable() + "<tr><th>stage</th>";
  std::vector<const ScaleRun*> runs;
  for (const ScaleRun& run : report.runs) {
    if (run.point == point) runs.push_back(&run);
  }
  for (const ScaleRun* run : runs) text += "<th>" + setName(report, *run) + "</th>";
  text += "</tr>\n";
  for (const StageTime& stage : runs.front()->stages) {
    text += "<tr><td>" + escaped(stage.name) + "</td>";
    for (const ScaleRun* run : runs) {
      const auto found = std::find_if(run->stages.begin(), run->stages.end(),
                                      [&](const StageTime& other) { return other.name == stage.name; });
      text += "<td>" + (found == run->stages.end() ? "-" : print("%.2f", found->ms)) + "</td>";
    }
    text += "</tr>\n";
  }
  return text + closeTable();
}

}  // namespace

std::string htmlOf(const ScaleReport& report, const ScaleOrigin& origin) {
  const size_t last = report.sensors.size() - 1;
  std::string html = openPage("Cyber Radar: scaling over devices", "How it scales over devices") + "<p>" +
                     escaped(origin.scene) + "; " + escaped(origin.mode) + "</p>\n<p class=\"soft\">" +
                     escaped(origin.date) + ", commit " + escaped(origin.commit) +
                     print(", %u processor cores</p>\n<p class=\"soft\"><code>", report.processors) +
                     escaped(origin.command) + "</code></p>\n";
  for (size_t i = 0; i < report.devices.size(); ++i) {
    html += print("<p class=\"soft\">device %u: ", report.numbers[i]) + escaped(report.devices[i].name) + ", " +
            escaped(report.devices[i].driver) + "</p>\n";
  }
  html += "<h2>What limits it</h2>\n<ul class=\"findings\">\n";
  for (const std::string& finding : findingsOf(report)) html += "<li>" + escaped(finding) + "</li>\n";
  html += std::string("</ul>\n<p class=\"soft\">Every set of devices gave ") +
          (report.sameBits ? "the same answers, to the bit.</p>\n" : "answers of its own.</p>\n");
  html += "<h2>Curves</h2>\n" + charts(report) + "<h2>Timelines</h2>\n" +
          print("<p>%g sensors, the pass of median time. ", report.sensors[last]) +
          "<span class=\"key\"><span><i style=\"background:var(--c0)\"></i>with the device</span>"
          "<span><i style=\"background:var(--c1)\"></i>encode and submit</span>"
          "<span><i style=\"background:var(--c5)\"></i>wait</span>"
          "<span><i style=\"background:var(--c2)\"></i>decode</span></span></p>\n";
  for (const ScaleRun& run : report.runs) {
    if (run.point == last && !run.alone) html += timelineOf(report, run);
  }
  html += "<h2>Times</h2>\n" + runsTable(report);
  html += print("<h2>Devices and their threads, %g sensors</h2>\n", report.sensors[last]) + sharesTable(report, last);
  html +=
      "<h2>Where the devices' time goes</h2>\n<p class=\"soft\">Of the devices' number times the time that passed. "
      "Useful: as long as each device alone takes for as many queries.</p>\n" +
      lossesTable(report, last);
  html +=
      "<h2>Stages</h2>\n<p class=\"soft\">Milliseconds of a pass of its own, by timestamps, summed over devices; "
      "select, encode and decode are the threads'.</p>\n" +
      stagesTable(report, last);
  return html + closePage();
}

}  // namespace radar::tools
