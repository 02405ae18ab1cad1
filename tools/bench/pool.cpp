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

Method methodOf(const char* name, Pool& pool, Mode mode) {
  return {name, [&pool, mode](std::span<const Query> queries) {
            return pool.submit({queries.begin(), queries.end()}, mode).get().results;
          }};
}

void overhead(const Device& device, const Scene& scene, const Batch& batch, const char* name, Mode mode, bool select,
              int& status) {
  const SweeperOptions options{.select = select, .cpuBatch = 0};
  // One thread at a time uses the queue: the pool sleeps while the sweeper runs.
  Sweeper sweeper(device, scene, options);
  Pool pool({&device, 1}, scene, options);
  printRows(name,
            {{"sweeper", [&](auto queries) { return sweeper.run(queries, mode).results; }},
             methodOf("pool of one device", pool, mode)},
            {&batch, 1}, {.warmUps = 3, .least = 13, .most = 13}, status);
}

// One device at a time takes `factor` times as long: what its thread waits, it waits again. These functions stand for
// the driver's.
struct Slowed {
  gpu::Api driver;
  int factor;
  double start = now(), doneAt = now();
};
std::unique_ptr<Slowed> slowed;

VkResult submitSlowly(VkQueue queue, uint32_t count, const VkSubmitInfo2* submits, VkFence fence) {
  slowed->start = now();
  return slowed->driver.QueueSubmit2(queue, count, submits, fence);
}

VkResult waitSlowly(VkDevice device, uint32_t count, const VkFence* fences, VkBool32 all, uint64_t timeout) {
  const VkResult waited = slowed->driver.WaitForFences(device, count, fences, all, timeout);
  const double took = now() - std::max(slowed->start, slowed->doneAt);
  std::this_thread::sleep_for(std::chrono::duration<double>(took * (slowed->factor - 1)));
  slowed->doneAt = now();
  return waited;
}

void slow(const Device& device, int factor) {
  gpu::Api& vk = device.impl().vk;
  slowed = std::make_unique<Slowed>(Slowed{vk, factor});
  vk.QueueSubmit2 = submitSlowly;
  vk.WaitForFences = waitSlowly;
}

void unequal(std::span<const Device> devices, const Scene& scene, const Batch& batch, int factor, int& status) {
  slow(devices[1], factor);
  Pool first(devices.first(1), scene), second(devices.subspan(1, 1), scene), both(devices, scene);
  const std::vector<double> us =
      printRows("second device " + std::to_string(factor) + " times slower",
                {methodOf("first device", first, Mode::sampled), methodOf("second device", second, Mode::sampled),
                 methodOf("both", both, Mode::sampled)},
                {&batch, 1}, {.warmUps = 3, .least = 7, .most = 7}, status);
  devices[1].impl().vk = slowed->driver;
  std::printf("# both: %.0f%% of the sum of the speeds of each\n", 100 / (1 / us[0] + 1 / us[1]) / us[2]);
}

}  // namespace

void addPool(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("pool", "A pool beside a plain sweeper, and on two devices of unequal speed");
  command->callback([&status] {
    const std::vector<Device> devices = openDevices();
    printHead(devices);
    const tools::Workload workload = tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1});
    Batch batch = batchesOf(workload).front();
    tools::ScenePlayer player(workload);
    player.show(batch.scene);
    overhead(devices[0], player.scene(), batch, "naive", Mode::sampled, false, status);
    overhead(devices[0], player.scene(), batch, "sampled", Mode::sampled, true, status);
    overhead(devices[0], player.scene(), batch, "contact", Mode::contact, true, status);
    if (devices.size() < 2) return;
    // Large enough that the last chunk of a slow device is a small part.
    const std::vector<Query> once = batch.queries;
    for (int i = 1; i < 8; ++i) batch.queries.insert(batch.queries.end(), once.begin(), once.end());
    for (const int factor : {2, 4}) {
      unequal(std::span(devices).first(2), player.scene(), batch, factor, status);
    }
  });
}

}  // namespace radar::bench
