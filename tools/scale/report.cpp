#include "scale/report.h"

#include <algorithm>

namespace radar::tools {

namespace {

std::string setOf(const ScaleReport& report, const ScaleRun& run) {
  std::string text;
  for (const uint32_t device : run.devices) text += (text.empty() ? "" : "+") + std::to_string(report.numbers[device]);
  return text;
}

}  // namespace

Json runTable(const ScaleReport& report) {
  Json table = Json::array();
  for (const ScaleRun& run : report.runs) {
    const double all = run.ms * static_cast<double>(run.devices.size());
    DeviceShare sum;
    double useful = 0;
    for (size_t i = 0; i < run.shares.size(); ++i) {
      const DeviceShare& share = run.shares[i];
      const DeviceShare& alone = report.alone(run.point, run.devices[i]).shares[0];
      useful += alone.queries > 0 ? alone.busy / alone.queries * share.queries : 0;
      sum.busy += share.busy;
      sum.start += share.start;
      sum.gap += share.gap;
      sum.tail += share.tail;
      sum.encode += share.encode;
    }
    table.push_back({{"sensors", report.sensors[run.point]},
                     {"devices", setOf(report, run)},
                     {"ms_per_batch", run.ms / static_cast<double>(report.batches[run.point])},
                     {"speed_up", report.speedUp(run)},
                     {"efficiency", report.efficiency(run)},
                     {"useful_%", 100 * useful / all},
                     {"slower_%", 100 * (sum.busy - useful) / all},
                     {"start_%", 100 * sum.start / all},
                     {"gap_%", 100 * sum.gap / all},
                     {"tail_%", 100 * sum.tail / all},
                     {"scene_%", 100 * run.scene / run.ms},
                     {"encode_%", sum.busy > 0 ? 100 * sum.encode / sum.busy : 0},
                     {"cores", run.cores}});
  }
  return table;
}

Json shareTable(const ScaleReport& report) {
  Json table = Json::array();
  for (const ScaleRun& run : report.runs) {
    for (size_t i = 0; i < run.shares.size(); ++i) {
      const DeviceShare& share = run.shares[i];
      table.push_back({{"sensors", report.sensors[run.point]},
                       {"devices", setOf(report, run)},
                       {"device", report.numbers[run.devices[i]]},
                       {"batches", report.batches[run.point]},
                       {"queries", report.queries[run.point]},
                       {"ms", run.ms},
                       {"ms_least", run.least},
                       {"ms_most", run.most},
                       {"speed_up", report.speedUp(run)},
                       {"efficiency", report.efficiency(run)},
                       {"cores", run.cores},
                       {"device_queries", share.queries},
                       {"chunks", share.chunks},
                       {"chunk_least", share.leastChunk},
                       {"chunk_most", share.mostChunk},
                       {"busy_ms", share.busy},
                       {"idle_start_ms", share.start},
                       {"idle_gap_ms", share.gap},
                       {"idle_tail_ms", share.tail},
                       {"encode_ms", share.encode},
                       {"wait_ms", share.wait},
                       {"decode_ms", share.decode}});
    }
  }
  return table;
}

Json stageTable(const ScaleReport& report) {
  Json table = Json::array();
  for (const ScaleRun& run : report.runs) {
    for (const StageTime& stage : run.stages) {
      table.push_back({{"devices", setOf(report, run)}, {"stage", stage.name}, {"ms", stage.ms}});
    }
  }
  return table;
}

std::string traceOf(const ScaleReport& report) {
  Json events = Json::array();
  const auto name = [&](const char* what, size_t process, size_t thread, const std::string& text) {
    events.push_back({{"name", what}, {"ph", "M"}, {"pid", process}, {"tid", thread}, {"args", {{"name", text}}}});
  };
  const auto span = [&](const std::string& text, size_t process, size_t thread, double from, double to, Json args) {
    if (to <= from) return;
    events.push_back({{"name", text},
                      {"ph", "X"},
                      {"pid", process},
                      {"tid", thread},
                      {"ts", 1e3 * from},
                      {"dur", 1e3 * (to - from)},
                      {"args", std::move(args)}});
  };
  for (size_t r = 0; r < report.runs.size(); ++r) {
    const ScaleRun& run = report.runs[r];
    if (run.point + 1 < report.sensors.size()) continue;
    name("process_name", r, 0, "devices " + setOf(report, run));
    name("thread_name", r, 0, "batches");
    const double origin = run.batches.front().submitted;
    for (size_t i = 0; i < run.devices.size(); ++i) {
      const std::string number = std::to_string(report.numbers[run.devices[i]]);
      name("thread_name", r, 2 * i + 1, "device " + number);
      name("thread_name", r, 2 * i + 2, "thread of device " + number);
    }
    std::vector<double> free(run.devices.size(), 0);
    for (size_t b = 0; b < run.batches.size(); ++b) {
      const PoolAnswers& batch = run.batches[b];
      span("batch " + std::to_string(b), r, 0, batch.submitted - origin, batch.answered - origin, Json::object());
      for (const ChunkTrace& chunk : batch.chunks) {
        const size_t thread = 2 * chunk.device + 2;
        const Json args{{"queries", chunk.queries}};
        // A device does one after the other: what is submitted meanwhile waits in its queue.
        double& since = free[chunk.device];
        span("chunk of " + std::to_string(chunk.queries), r, thread - 1, std::max(chunk.submitted - origin, since),
             chunk.done - origin, args);
        since = std::max(since, chunk.done - origin);
        span("encode and submit", r, thread, chunk.begun - origin, chunk.submitted - origin, args);
        span("wait", r, thread, chunk.awaited - origin, chunk.done - origin, args);
        span("decode", r, thread, std::max(chunk.done, chunk.awaited) - origin, chunk.decoded - origin, args);
      }
    }
  }
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}.dump() + "\n";
}

}  // namespace radar::tools
