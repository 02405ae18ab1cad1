// Mode bounded, and each way of drawing its outer scopes, beside modes sampled and contact within one run: time, how
// wide its bracket is, how much it decides. Without validation layers, medians after a warm-up.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>

#include "commit/commit.h"
#include "gpu/device.h"
#include "radar/radar.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

constexpr int kRepeats = 7;

double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// A way to ask, and what it gave.
struct Way {
  const char* label;
  Mode mode;
  uint32_t resolution;
  std::optional<bool> byPixel = {};             ///< how outer scopes are drawn; else as the engine chooses
  std::vector<double> times = {}, widths = {};  ///< milliseconds per query of a batch; hi - lo of hits
  size_t undecided = 0;
  std::vector<StageTime> stages = {};  ///< of the last batch, per query
};

// Answers every batch of the workload in each way, in turns, so that what else the machine does strikes all alike.
// Returns the number of queries.
size_t measure(const Device& device, const tools::Workload& workload, std::span<Way> ways) {
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device, player.scene()), profiled(device, player.scene(), {.timestamps = true});
  size_t asked = 0;
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    for (uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], Mode::bounded));
    asked += queries.size();
    for (int repeat = 0; repeat <= kRepeats; ++repeat) {
      for (Way& way : ways) {
        for (Query& query : queries) {
          query.mode = way.mode;
          query.resolution = way.resolution;
        }
        device.impl().outerByPixel = way.byPixel;
        const Clock::time_point start = Clock::now();
        const std::vector<Result> results = sweeper.run(queries);
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        if (repeat > 0) {
          way.times.push_back(ms / queries.size());
          continue;
        }
        for (const Result& result : results) {
          way.undecided += result.status == Status::undecided;
          if (result.status == Status::hit) way.widths.push_back(result.hi - result.lo);
        }
        profiled.run(queries);
        way.stages = profiled.stats().stages;
        for (StageTime& stage : way.stages) stage.ms /= queries.size();
      }
    }
  }
  return asked;
}

}  // namespace

int main() {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), tools::commit());
  const std::pair<const char*, tools::Workload> workloads[] = {
      {"Table 1, 30000 boxes, 64 box sensors",
       tools::makeWorkload(tools::Table1{.boxes = 30'000, .shape = tools::SensorShape::box})},
      {"Table 1, 30000 boxes, 64 teapot sensors", tools::makeWorkload(tools::Table1{.boxes = 30'000})},
      {"Figure 7, 30 teapots among 2000 boxes, 4 steps",
       tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 4})}};
  for (const auto& [name, workload] : workloads) {
    std::printf("%s\n", name);
    Way ways[] = {{"bounded 64", Mode::bounded, 64},
                  {"bounded 128", Mode::bounded, 128},
                  {"bounded 256", Mode::bounded, 256},
                  {"64 by triangle", Mode::bounded, 64, false},
                  {"128 by triangle", Mode::bounded, 128, false},
                  {"256 by triangle", Mode::bounded, 256, false},
                  {"64 by pixel", Mode::bounded, 64, true},
                  {"256 by pixel", Mode::bounded, 256, true},
                  {"sampled 256", Mode::sampled, 256},
                  {"contact", Mode::contact, 0}};
    const size_t asked = measure(device, workload, ways);
    for (const Way& way : ways) {
      std::printf("  %-15s %7.3f ms per sensor  width %.5f  decided %5.1f%%  (", way.label, median(way.times),
                  median(way.widths), 100 - 100.0 * way.undecided / asked);
      for (const StageTime& stage : way.stages) std::printf(" %s %.3f", stage.name.c_str(), stage.ms);
      std::printf(")\n");
    }
    std::printf("  bounded at 64 / sampled at 256: %.2f\n", median(ways[0].times) / median(ways[8].times));
  }
}
