// Mode bounded beside modes sampled and contact within one run: time, how wide its bracket is, how much it decides.
// Without validation layers, medians after a warm-up.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

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

struct Row {
  double ms = 0;  ///< median of a step's batch, per query
  double width = 0, decided = 0;
  std::vector<StageTime> stages;
};

// All steps of a workload, asked one way.
Row measure(const Device& device, const tools::Workload& workload, Mode mode, uint32_t resolution) {
  tools::ScenePlayer player(workload);
  Sweeper sweeper(device, player.scene()), profiled(device, player.scene(), {.timestamps = true});
  std::vector<double> times, widths;
  size_t asked = 0, undecided = 0;
  Row row;
  for (const tools::Batch& batch : tools::batchesOf(workload)) {
    player.show(batch.scene);
    std::vector<Query> queries;
    for (uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], mode, resolution));
    for (const Result& result : sweeper.run(queries)) {
      undecided += result.status == Status::undecided;
      if (result.status == Status::hit) widths.push_back(result.hi - result.lo);
    }
    asked += queries.size();
    for (int i = 0; i < kRepeats; ++i) {
      const Clock::time_point start = Clock::now();
      sweeper.run(queries);
      times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count() / queries.size());
    }
    profiled.run(queries);
    profiled.run(queries);
    row.stages = profiled.stats().stages;
    for (StageTime& stage : row.stages) stage.ms /= queries.size();
  }
  row.ms = median(times);
  row.width = median(widths);
  row.decided = 100 - 100.0 * undecided / asked;
  return row;
}

void print(const char* label, const Row& row) {
  std::printf("  %-13s %8.3f ms per sensor  width %.5f  decided %5.1f%%  (", label, row.ms, row.width, row.decided);
  for (const StageTime& stage : row.stages) std::printf(" %s %.3f", stage.name.c_str(), stage.ms);
  std::printf(")\n");
}

}  // namespace

int main() {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), RADAR_COMMIT);
  const std::pair<const char*, tools::Workload> workloads[] = {
      {"Table 1, 30000 boxes, 64 box sensors",
       tools::makeWorkload(tools::Table1{.boxes = 30'000, .shape = tools::SensorShape::box})},
      {"Table 1, 30000 boxes, 64 teapot sensors", tools::makeWorkload(tools::Table1{.boxes = 30'000})},
      {"Figure 7, 30 teapots among 2000 boxes, 4 steps",
       tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 4})}};
  for (const auto& [name, workload] : workloads) {
    std::printf("%s\n", name);
    const Row coarse = measure(device, workload, Mode::bounded, 64);
    print("bounded 64", coarse);
    print("bounded 128", measure(device, workload, Mode::bounded, 128));
    print("bounded 256", measure(device, workload, Mode::bounded, 256));
    const Row sampled = measure(device, workload, Mode::sampled, 256);
    print("sampled 256", sampled);
    print("contact", measure(device, workload, Mode::contact, 0));
    std::printf("  bounded at 64 / sampled at 256: %.2f\n", coarse.ms / sampled.ms);
  }
}
