// Ratios of Table 1's scene within one run: select against drawing everything, and 30,000 boxes against 10,000.
// Without validation layers, medians after a warm-up.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "radar/radar.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

struct Timed {
  double ms = 0;  ///< median, per batch
  SweepStats stats;
};

Timed timeBatch(const Device& device, const Scene& scene, const std::vector<Query>& queries, bool select, int repeats) {
  Sweeper sweeper(device, scene, {.select = select, .timestamps = false});
  sweeper.run(queries);
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Clock::time_point start = Clock::now();
    sweeper.run(queries);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  Sweeper profiled(device, scene, {.select = select, .timestamps = true});
  profiled.run(queries);
  profiled.run(queries);
  return {times[repeats / 2], profiled.stats()};
}

void print(const char* label, const Timed& timed, size_t sensors) {
  std::printf("  %-26s %8.3f ms per sensor  (objects drawn per sensor %.1f;", label, timed.ms / sensors,
              double(timed.stats.drawnObjects) / sensors);
  for (const StageTime& stage : timed.stats.stages) std::printf(" %s %.3f", stage.name.c_str(), stage.ms / sensors);
  std::printf(")\n");
}

}  // namespace

int main(int argc, char**) {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), RADAR_COMMIT);
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    std::printf("%s sensors, batch of 64 at 256^2\n", shape == tools::SensorShape::box ? "box" : "teapot");
    double culled[2], naive = 0;
    for (int large = 0; large < 2; ++large) {
      const uint32_t boxes = large ? 30'000 : 10'000;
      const tools::Workload workload = tools::makeWorkload(tools::Table1{.boxes = boxes, .shape = shape});
      tools::ScenePlayer player(workload);
      player.show(0);
      std::vector<Query> queries;
      for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::sampled, 256));
      const Timed timed = timeBatch(device, player.scene(), queries, true, 7);
      culled[large] = timed.ms;
      print((std::to_string(boxes) + " boxes, select").c_str(), timed, queries.size());
      if (large && argc < 2) {
        const Timed all = timeBatch(device, player.scene(), queries, false, 3);
        naive = all.ms;
        print((std::to_string(boxes) + " boxes, drawing all").c_str(), all, queries.size());
      }
    }
    std::printf("  drawing all / select at 30,000: %.2f\n  30,000 / 10,000 with select: %.2f\n", naive / culled[1],
                culled[1] / culled[0]);
  }
}
