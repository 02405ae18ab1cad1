// What a pool costs beside a plain sweeper on one device, and what it makes of two devices of which one is slowed on
// purpose. Ratios within one run, without validation layers, medians after a warm-up.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "commit/commit.h"
#include "gpu/device.h"
#include "radar/pool.h"
#include "report/median.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

template <class Work>
double timed(Work&& work) {
  const Clock::time_point start = Clock::now();
  work();
  return msSince(start);
}

struct Scenario {
  const char* name;
  Mode mode;
  bool select;
};

void overhead(const Device& device, const Scene& scene, std::vector<Query> queries, const Scenario& scenario) {
  for (Query& query : queries) query.mode = scenario.mode;
  Sweeper sweeper(device, scene, {.select = scenario.select, .cpuBatch = 0});
  std::vector<double> plain, pooled;
  // One thread at a time uses the queue: the pool sleeps while the sweeper runs.
  Pool pool({&device, 1}, scene, {.select = scenario.select, .cpuBatch = 0});
  for (int i = 0; i < 16; ++i) {
    const double one = timed([&] { sweeper.run(queries); });
    const double other = timed([&] { pool.submit(queries).get(); });
    if (i < 3) continue;
    plain.push_back(one);
    pooled.push_back(other);
  }
  std::printf("%-10s sweeper %9.3f ms, pool of one device %9.3f ms: %+.1f%%\n", scenario.name, tools::median(plain),
              tools::median(pooled), 100 * (tools::median(pooled) / tools::median(plain) - 1));
}

/// The device takes `factor` times as long: what its thread waits, it waits again.
void slow(const Device& device, double factor) {
  auto start = std::make_shared<Clock::time_point>(Clock::now());
  auto doneAt = std::make_shared<Clock::time_point>(Clock::now());
  device.impl().fault = [=](std::string_view call) {
    if (call == "vkQueueSubmit2") *start = Clock::now();
    if (call == "vkWaitForFences") {
      const auto took = Clock::now() - std::max(*start, *doneAt);
      std::this_thread::sleep_for(took * (factor - 1));
      *doneAt = Clock::now();
    }
    return VK_SUCCESS;
  };
}

void unequal(std::span<const Device> devices, const Scene& scene, const std::vector<Query>& queries, double factor) {
  slow(devices[1], factor);
  Pool first(devices.first(1), scene), second(devices.subspan(1, 1), scene), both(devices, scene);
  std::vector<double> times[3];
  for (int i = 0; i < 10; ++i) {
    int k = 0;
    for (Pool* pool : {&first, &second, &both}) {
      const double ms = timed([&] { pool->submit(queries).get(); });
      if (i >= 3) times[k].push_back(ms);
      ++k;
    }
  }
  devices[1].impl().fault = nullptr;
  const double a = tools::median(times[0]), b = tools::median(times[1]), ab = tools::median(times[2]);
  std::printf(
      "%zu queries, second device %.0f times slower: alone %.1f ms and %.1f ms, together %.1f ms: %.0f%% of the "
      "ideal\n",
      queries.size(), factor, a, b, ab, 100 / (1 / a + 1 / b) / ab);
}

}  // namespace

int main() {
  const std::vector<Device> devices = openDevices();
  std::printf("%zu devices, %s, driver %s, commit %s\n", devices.size(), devices[0].name().c_str(),
              devices[0].driver().c_str(), tools::commit());
  const tools::Workload workload = tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1});
  tools::ScenePlayer player(workload);
  player.show(workload.queries[0].scene);
  std::vector<Query> queries;
  for (const tools::QuerySpec& spec : workload.queries) queries.push_back(tools::toQuery(spec, Mode::sampled));
  for (const Scenario& scenario :
       {Scenario{"naive", Mode::sampled, false}, {"sampled", Mode::sampled, true}, {"contact", Mode::contact, true}}) {
    overhead(devices[0], player.scene(), queries, scenario);
  }
  if (devices.size() < 2) return 0;
  // Large enough that the last chunk of a slow device is a small part.
  std::vector<Query> many;
  for (int i = 0; i < 8; ++i) many.insert(many.end(), queries.begin(), queries.end());
  for (const double factor : {2.0, 4.0}) unequal(std::span(devices).first(2), player.scene(), many, factor);
}
