#include <nlohmann/json.hpp>

#include "report/print.h"
#include "scale/findings.h"
#include "scale/report.h"

namespace radar::tools {

namespace {

std::string setOf(const ScaleReport& report, const ScaleRun& run) {
  std::string text;
  for (const uint32_t device : run.devices) text += (text.empty() ? "" : "+") + std::to_string(report.numbers[device]);
  return text;
}

}  // namespace

std::string tableOf(const ScaleReport& report) {
  std::string text = "sensors  devices  ms a batch  speed-up  efficiency  busy             chunks\n";
  for (const ScaleRun& run : report.runs) {
    std::string busy, chunks;
    for (const DeviceShare& share : run.shares) {
      busy += print("%s%.0f%%", busy.empty() ? "" : " ", 100 * share.busy / run.ms);
      chunks += print("%s%u of %u-%u", chunks.empty() ? "" : ", ", share.chunks, share.leastChunk, share.mostChunk);
    }
    text += print("%7.0f  %7s  %10.3f  %8.2f  %9.0f%%  %-15s  %s\n", report.sensors[run.point],
                  setOf(report, run).c_str(), run.ms / static_cast<double>(report.batches[run.point]),
                  report.speedUp(run), 100 * report.efficiency(run), busy.c_str(), chunks.c_str());
  }
  text += "\nStages, milliseconds of a pass with timestamps, summed over devices:\n";
  for (const ScaleRun& run : report.runs) {
    if (run.stages.empty()) continue;
    text += "devices " + setOf(report, run);
    for (const StageTime& stage : run.stages) text += print(", %s %.2f", stage.name.c_str(), stage.ms);
    text += "\n";
  }
  return text;
}

std::string csvOf(const ScaleReport& report) {
  std::string text =
      "sensors,devices,device,batches,queries,ms,ms_least,ms_most,speed_up,efficiency,cores,device_queries,chunks,"
      "chunk_least,chunk_most,busy_ms,idle_start_ms,idle_gap_ms,idle_tail_ms,encode_ms,wait_ms,decode_ms\n";
  for (const ScaleRun& run : report.runs) {
    for (size_t i = 0; i < run.shares.size(); ++i) {
      const DeviceShare& share = run.shares[i];
      text += print("%g,%s,%u,%zu,%zu,%.4f,%.4f,%.4f,%.4f,%.4f,%.3f,", report.sensors[run.point],
                    setOf(report, run).c_str(), report.numbers[run.devices[i]], report.batches[run.point],
                    report.queries[run.point], run.ms, run.least, run.most, report.speedUp(run), report.efficiency(run),
                    run.cores);
      text += print("%u,%u,%u,%u,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f,%.4f\n", share.queries, share.chunks, share.leastChunk,
                    share.mostChunk, share.busy, share.start, share.gap, share.tail, share.encode, share.wait,
                    share.decode);
    }
  }
  return text;
}

std::string traceOf(const ScaleReport& report) {
  using Json = nlohmann::ordered_json;
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
