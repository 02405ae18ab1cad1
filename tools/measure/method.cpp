#include "measure/method.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <optional>
#include <thread>

#include "radar/cpu_sweeper.h"

namespace radar::tools {

namespace {

// Pixels, rays or steps outside of section front.
constexpr uint32_t kOneSize = 64;

// `make` makes what answers in a scene, and `ask` asks it.
template <class Make, class Ask>
Session searching(const Workload& workload, const Make& make, const Ask& ask) {
  struct Search {
    Search(const Workload& workload, const Make& make) : player(workload), searcher(make(player.scene())) {}
    ScenePlayer player;
    std::invoke_result_t<Make, const Scene&> searcher;
  };
  const auto search = std::make_shared<Search>(workload, make);
  return {"", [search, ask](std::span<const Query> queries) { return resultsOf(ask(search->searcher, queries)); },
          [search](uint32_t scene) {
            search->player.show(scene);
            search->searcher.sync();
          }};
}

Method onDevice(const Device& device, Mode mode, const std::string& family, uint32_t size = 0,
                const SweeperOptions& options = {}) {
  return {.family = family,
          .size = size,
          .certified = mode == Mode::contact,
          .open = [&device, mode, options](const Workload& workload) {
            return searching(
                workload, [&](const Scene& scene) { return Sweeper(device, scene, options); },
                [mode](Sweeper& sweeper, std::span<const Query> queries) { return sweeper.run(queries, mode); });
          }};
}

Method onCpu(uint32_t threads) {
  return {.family = "reference", .threads = threads, .certified = true, .open = [threads](const Workload& workload) {
            return searching(
                workload, [&](const Scene& scene) { return CpuSweeper(scene, threads); },
                [](CpuSweeper& cpu, std::span<const Query> queries) { return cpu.run(queries); });
          }};
}

std::vector<uint32_t> resolutions(Extent extent) {
  if (extent == Extent::full) return {16, 32, 64, 128, 256, 512, 1024};
  if (extent == Extent::quick) return {16, 64, 256};
  return {64, 256};
}

// Calls body(thread, i) for each i below `count`, in so many threads.
template <class Body>
void inThreads(uint32_t threads, size_t count, const Body& body) {
  std::atomic<size_t> next = 0;
  const auto work = [&](uint32_t thread) {
    for (size_t i = next++; i < count; i = next++) body(thread, i);
  };
  std::vector<std::thread> others;
  for (uint32_t thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
  work(0);
  for (std::thread& other : others) other.join();
}

// What a baseline tells: no bounds.
Result resultOf(const std::optional<double>& t) {
  Result result;
  result.status = t ? Status::hit : Status::clear;
  result.t = t.value_or(NAN);
  result.lo = result.hi = NAN;
  return result;
}

// One baseline for each thread.
Session casting(const Workload& workload, const BaselineRow& row, uint32_t size, uint32_t threads) {
  struct Casts {
    std::vector<std::unique_ptr<Baseline>> baselines;
    std::optional<uint32_t> shown;
  };
  const auto casts = std::make_shared<Casts>();
  for (uint32_t i = 0; i < threads; ++i) casts->baselines.push_back(row.make(workload, size));
  return {"",
          [casts](std::span<const Query> queries) {
            std::vector<Result> results(queries.size());
            inThreads(static_cast<uint32_t>(casts->baselines.size()), queries.size(), [&](uint32_t thread, size_t i) {
              results[i] = resultOf(casts->baselines[thread]->cast(queries[i]));
            });
            return results;
          },
          [casts, &workload](uint32_t scene) {
            if (casts->shown == scene) return;
            std::vector<Instance> objects;
            for (uint32_t i = 0; i < workload.objectCount(scene); ++i) objects.push_back(workload.instance(scene, i));
            for (const std::unique_ptr<Baseline>& baseline : casts->baselines) baseline->show(objects);
            casts->shown = scene;
          }};
}

template <class Values, class Value>
bool has(const Values& values, const Value& value) {
  return std::find(values.begin(), values.end(), value) != values.end();
}

std::vector<uint32_t> sizesOf(const BaselineRow& row, const std::string& section, Extent extent) {
  if (section != "front") return {has(row.sizes, kOneSize) ? kOneSize : row.sizes.front()};
  if (row.sizes.size() == 1 || extent == Extent::full) return row.sizes;
  return extent == Extent::quick ? std::vector<uint32_t>{16, 64, 256} : std::vector<uint32_t>{16};
}

}  // namespace

std::vector<Method> ours(const Device& device, const std::string& section, Extent extent, uint32_t threads) {
  std::vector<Method> methods;
  if (section == "front") {
    for (const uint32_t size : resolutions(extent)) methods.push_back(onDevice(device, Mode::sampled, "sampled", size));
  }
  if (section == "table1") {
    methods.push_back(onDevice(device, Mode::sampled, "drawing all", kOneSize, {.select = false}));
  }
  if (section == "table1" || section == "growth") {
    methods.push_back(onDevice(device, Mode::sampled, "sampled", kOneSize));
  }
  methods.push_back(onDevice(device, Mode::contact, "contact"));
  methods.push_back(onDevice(device, Mode::contact, "contact on device", 0, {.cpuBatch = 0}));
  methods.push_back(onCpu(1));
  if (threads > 1) methods.push_back(onCpu(threads));
  return methods;
}

std::vector<Method> others(std::span<const BaselineRow> rows, const std::string& section, Extent extent,
                           uint32_t threads) {
  const bool full = extent == Extent::full;
  std::vector<Method> methods;
  for (const BaselineRow& row : rows) {
    if (!has(row.sections, section) || (section == "growth" && !full)) continue;
    for (const uint32_t size : sizesOf(row, section, extent)) {
      const auto add = [&](uint32_t number) {
        methods.push_back(
            {.family = row.family,
             .size = size,
             .threads = number,
             .apart = true,
             .open = [row, size, number](const Workload& workload) { return casting(workload, row, size, number); }});
      };
      const uint32_t most = row.threads ? threads : 1;
      if (full || most == 1) add(1);
      if (most > 1) add(most);
    }
  }
  return methods;
}

}  // namespace radar::tools
