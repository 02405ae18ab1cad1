// What a pool costs beside a plain sweeper on one device, and what it makes of two devices of which one is slowed on
// purpose.
#include "radar/pool.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>

#include "bench/benchmarks.h"
#include "gpu/device.h"
#include "workloads/generate.h"

namespace radar::bench {

namespace {

Method methodOf(const char* name, Pool& pool) {
  return {name, [&pool](std::span<const Query> queries) {
            return pool.submit({queries.begin(), queries.end()}).get().results;
          }};
}

// Returns the medians in milliseconds.
std::vector<double> race(const std::vector<Method>& methods, const Batch& batch, uint32_t passes, int& status) {
  std::vector<double> ms;
  for (const Series& series : measure(methods, {&batch, 1}, {.warmUps = 3, .least = passes, .most = passes})) {
    ms.push_back(medianMs(series.answer));
    if (series.differ > 0) status = 1;
  }
  return ms;
}

void overhead(const Device& device, const Scene& scene, Batch batch, const char* name, Mode mode, bool select,
              int& status) {
  for (Query& query : batch.queries) query.mode = mode;
  const SweeperOptions options{.select = select, .cpuBatch = 0};
  // One thread at a time uses the queue: the pool sleeps while the sweeper runs.
  Sweeper sweeper(device, scene, options);
  Pool pool({&device, 1}, scene, options);
  const std::vector<double> ms = race(
      {{"sweeper", [&](auto queries) { return sweeper.run(queries); }}, methodOf("pool", pool)}, batch, 13, status);
  std::printf("%-10s sweeper %9.3f ms, pool of one device %9.3f ms: %+.1f%%\n", name, ms[0], ms[1],
              100 * (ms[1] / ms[0] - 1));
}

// The device takes `factor` times as long: what its thread waits, it waits again.
void slow(const Device& device, double factor) {
  auto start = std::make_shared<double>(now()), doneAt = std::make_shared<double>(now());
  device.impl().fault = [=](std::string_view call) {
    if (call == "vkQueueSubmit2") *start = now();
    if (call == "vkWaitForFences") {
      const double took = now() - std::max(*start, *doneAt);
      std::this_thread::sleep_for(std::chrono::duration<double>(took * (factor - 1)));
      *doneAt = now();
    }
    return VK_SUCCESS;
  };
}

void unequal(std::span<const Device> devices, const Scene& scene, const Batch& batch, double factor, int& status) {
  slow(devices[1], factor);
  Pool first(devices.first(1), scene), second(devices.subspan(1, 1), scene), both(devices, scene);
  const std::vector<double> ms =
      race({methodOf("first", first), methodOf("second", second), methodOf("both", both)}, batch, 7, status);
  devices[1].impl().fault = nullptr;
  std::printf(
      "%zu queries, second device %.0f times slower: alone %.1f ms and %.1f ms, together %.1f ms: %.0f%% of the "
      "ideal\n",
      batch.queries.size(), factor, ms[0], ms[1], ms[2], 100 / (1 / ms[0] + 1 / ms[1]) / ms[2]);
}

}  // namespace

void addPool(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("pool", "A pool beside a plain sweeper, and on two devices of unequal speed");
  command->callback([&status] {
    const std::vector<Device> devices = openDevices();
    for (const Device& device : devices) printOrigin(device);
    const tools::Workload workload = tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1});
    Batch batch = batchesOf(workload, Mode::sampled).front();
    tools::ScenePlayer player(workload);
    player.show(batch.scene);
    overhead(devices[0], player.scene(), batch, "naive", Mode::sampled, false, status);
    overhead(devices[0], player.scene(), batch, "sampled", Mode::sampled, true, status);
    overhead(devices[0], player.scene(), batch, "contact", Mode::contact, true, status);
    if (devices.size() < 2) return;
    // Large enough that the last chunk of a slow device is a small part.
    const std::vector<Query> once = batch.queries;
    for (int i = 1; i < 8; ++i) batch.queries.insert(batch.queries.end(), once.begin(), once.end());
    for (const double factor : {2.0, 4.0}) {
      unequal(std::span(devices).first(2), player.scene(), batch, factor, status);
    }
  });
}

}  // namespace radar::bench
