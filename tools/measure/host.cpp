#include "measure/host.h"

#include <algorithm>
#include <array>

#include "measure/timing.h"
#include "radar/cpu_sweeper.h"
#include "radar/radar.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

// The calling thread's stages; the others are the device's.
constexpr std::array kHostStages{"check", "select", "plan", "submit", "decode", "cpu"};

struct Call {
  double wall = 0, host = 0;  ///< seconds, and those computed by the calling thread
  std::vector<StageTime> stages;
};

Call callOf(Sweeper& sweeper, std::span<const Query> queries, Answers& answers) {
  const double host = threadSeconds(), wall = now();
  sweeper.run(queries, answers);
  return {now() - wall, threadSeconds() - host, answers.stats.stages};
}

bool isHosts(const StageTime& stage) {
  return std::ranges::find(kHostStages, stage.name) != kHostStages.end();
}

// Median seconds of what `of` takes of each call.
template <class Of>
double medianOf(const std::vector<Call>& calls, const Of& of) {
  std::vector<double> values;
  for (const Call& call : calls) values.push_back(of(call));
  return median(values);
}

Json rowOf(const std::string& workload, size_t queries, uint32_t threads, const std::vector<Call>& calls, double cpu) {
  const double each = 1e6 / static_cast<double>(queries);
  const auto stages = [&](const auto& isWanted) {
    return each * medianOf(calls, [&](const Call& call) {
             double sum = 0;
             for (const StageTime& stage : call.stages) sum += isWanted(stage) ? 1e-3 * stage.ms : 0;
             return sum;
           });
  };
  const double host = each * medianOf(calls, [](const Call& call) { return call.host; });
  Json row{{"workload", workload},
           {"batch", queries},
           {"threads", threads},
           {"call_us", each * medianOf(calls, [](const Call& call) { return call.wall; })},
           {"host_us", host}};
  for (const char* name : {"check", "plan", "submit", "decode"}) {
    row[std::string(name) + "_us"] = stages([&](const StageTime& stage) { return stage.name == name; });
  }
  row["device_us"] = stages([](const StageTime& stage) { return !isHosts(stage); });
  row["cpu_us"] = each * cpu;
  row["host_share"] = host / (each * cpu);
  return row;
}

}  // namespace

size_t hostRowCount(const HostSettings& settings) {
  return 2 * settings.queries.size() * settings.threads.size();
}

Json hostRows(const Device& device, const HostSettings& settings, const std::function<void()>& advance) {
  Json rows = Json::array();
  for (const auto& [name, boxes, shape] :
       {std::tuple{"boxes", 30'000u, SensorShape::box}, std::tuple{"teapots", 10'000u, SensorShape::teapot}}) {
    const uint32_t most = *std::ranges::max_element(settings.queries);
    const Workload workload = makeWorkload(Table1{.boxes = boxes, .sensors = most, .shape = shape});
    ScenePlayer player(workload);
    player.show(0);
    const std::vector<Query> all(workload.queries.begin(), workload.queries.end());
    CpuSweeper cpu(player.scene(), 1);
    for (const uint32_t count : settings.queries) {
      const std::span<const Query> queries = std::span(all).first(count);
      std::vector<double> searches;
      for (uint32_t i = 0; i <= settings.repeats; ++i) searches.push_back(lapOf([&] { cpu.run(queries); }).wall);
      for (const uint32_t threads : settings.threads) {
        Sweeper sweeper(device, player.scene(), {.timestamps = true, .cpuBatch = 0, .cpuThreads = threads});
        // Two for pipelines, lists and pace.
        Answers answers;
        for (int i = 0; i < 2; ++i) callOf(sweeper, queries, answers);
        std::vector<Call> calls;
        for (uint32_t i = 0; i < settings.repeats; ++i) calls.push_back(callOf(sweeper, queries, answers));
        rows.push_back(rowOf(name, count, threads, calls, median(searches)));
        advance();
      }
    }
  }
  return rows;
}

}  // namespace radar::tools
