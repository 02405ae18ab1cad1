// Ratios of Table 1's scene within one run: select against drawing everything, 30,000 boxes against 10,000, and mode
// contact against the reference on one thread.
// Without validation layers, medians after a warm-up.
#include <algorithm>
#include <chrono>
#include <cstdio>

#include "commit/commit.h"
#include "radar/radar.h"
#include "reference/reference.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

struct Timed {
  double ms = 0;  ///< median, per batch
  SweepStats stats;
};

double median(std::vector<double>& times) {
  std::nth_element(times.begin(), times.begin() + times.size() / 2, times.end());
  return times[times.size() / 2];
}

double timeReference(const Scene& scene, const std::vector<Query>& queries, int repeats) {
  reference::Reference exact(scene);
  exact.run(queries);
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Clock::time_point start = Clock::now();
    exact.run(queries);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  return median(times);
}

Timed timeBatch(const Device& device, const Scene& scene, const std::vector<Query>& queries, bool select, int repeats) {
  Sweeper sweeper(device, scene, {.select = select, .timestamps = false});
  sweeper.run(queries);
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const Clock::time_point start = Clock::now();
    sweeper.run(queries);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
  }
  Sweeper profiled(device, scene, {.select = select, .timestamps = true});
  profiled.run(queries);
  profiled.run(queries);
  return {median(times), profiled.stats()};
}

void print(const char* label, const Timed& timed, size_t sensors) {
  std::printf("  %-26s %8.3f ms per sensor  (objects drawn per sensor %.1f;", label, timed.ms / sensors,
              double(timed.stats.drawnObjects) / sensors);
  for (const StageTime& stage : timed.stats.stages) std::printf(" %s %.3f", stage.name.c_str(), stage.ms / sensors);
  std::printf(")\n");
}

}  // namespace

int main() {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), tools::commit());
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    std::printf("%s sensors, batch of 64 at 256^2\n", shape == tools::SensorShape::box ? "box" : "teapot");
    double culled[2], naive = 0, contact = 0, referenceMs = 0;
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
      if (large) {
        const Timed all = timeBatch(device, player.scene(), queries, false, 3);
        naive = all.ms;
        for (Query& query : queries) query.mode = Mode::contact;
        const Timed exact = timeBatch(device, player.scene(), queries, true, 7);
        contact = exact.ms;
        print("30000 boxes, contact", exact, queries.size());
        referenceMs = timeReference(player.scene(), queries, 7);
        std::printf("  %-26s %8.3f ms per sensor\n", "30000 boxes, reference", referenceMs / queries.size());
        print((std::to_string(boxes) + " boxes, drawing all").c_str(), all, queries.size());
      }
    }
    std::printf("  drawing all / select at 30,000: %.2f\n  30,000 / 10,000 with select: %.2f\n", naive / culled[1],
                culled[1] / culled[0]);
    std::printf("  contact / reference at 30,000: %.2f\n  sampled / contact at 30,000: %.2f\n", contact / referenceMs,
                culled[1] / contact);
  }
}
