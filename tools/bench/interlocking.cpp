// Mode contact direct, with its switch to the mask, and by the mask at once, beside the reference, within one run: on
// shapes that interlock, and on those for which the switch must cost nothing. Of all ways in turn, so that a busy
// moment meets them alike; medians after a warm-up, without validation layers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <deque>

#include "commit/commit.h"
#include "import/mesh_import.h"
#include "reference/reference.h"
#include "sweep/sweeper.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

constexpr int kRepeats = 5;

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// A way to search, and what it took.
struct Way {
  Way(const char* name, const Device& device, const Scene& scene, ContactWay way)
      : label(name), sweeper(device, scene, {}, std::make_shared<SceneCopy>(device.impl()), {.way = way}) {}
  const char* label;
  Sweeper::Impl sweeper;
  std::vector<Result> results = {};
  std::vector<double> times = {};  ///< milliseconds a query
};

template <class Run>
double timed(size_t queries, const Run& run) {
  const Clock::time_point start = Clock::now();
  run();
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count() / static_cast<double>(queries);
}

void measure(const Device& device, const std::string& name, const tools::Workload& workload) {
  tools::ScenePlayer player(workload);
  const tools::Batch batch = tools::batchesOf(workload).front();
  player.show(batch.scene);
  reference::Reference exact(player.scene());
  std::vector<Query> queries;
  for (const uint32_t i : batch.queries) queries.push_back(tools::toQuery(workload.queries[i], Mode::contact));
  std::deque<Way> ways;
  ways.emplace_back("direct", device, player.scene(), ContactWay::direct);
  ways.emplace_back("switch", device, player.scene(), ContactWay::cheaper);
  ways.emplace_back("masked", device, player.scene(), ContactWay::masked);
  std::vector<double> referenceTimes;
  for (int repeat = 0; repeat <= kRepeats; ++repeat) {
    for (Way& way : ways) {
      way.results.resize(queries.size());
      const double ms = timed(queries.size(), [&] {
        way.sweeper.begin(queries, way.results);
        way.sweeper.finish();
      });
      if (repeat > 0) way.times.push_back(ms);
    }
    const double ms = timed(queries.size(), [&] { exact.run(queries); });
    if (repeat > 0) referenceTimes.push_back(ms);
  }
  size_t hits = 0, unequal = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    hits += ways[0].results[i].status == Status::hit;
    for (const Way& way : ways) unequal += std::memcmp(&way.results[i], &ways[0].results[i], sizeof(Result)) != 0;
  }
  std::printf("%s: %zu queries, %zu hits, %zu answers differ\n", name.c_str(), queries.size(), hits, unequal);
  for (const Way& way : ways) {
    const SweepStats& stats = way.sweeper.stats;
    const double count = static_cast<double>(queries.size());
    std::printf("  %-9s %8.3f ms  (cluster pairs %.1f, box tests %.1f)\n", way.label, median(way.times),
                static_cast<double>(stats.clusterPairs) / count, static_cast<double>(stats.pairs) / count);
  }
  std::printf("  %-9s %8.3f ms\n  direct / switch: %.2f\n", "reference", median(referenceTimes),
              median(ways[0].times) / median(ways[1].times));
  std::fflush(stdout);
}

}  // namespace

// radar_bench_interlocking [mesh files]: those in random poses, too.
int main(int argc, char** argv) {
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), tools::commit());
  for (const tools::Interlocking kind : tools::kInterlocking) {
    measure(device, nameOf(kind), tools::makeWorkload(tools::InterlockingPairs{.kind = kind}));
  }
  measure(device, "teapots over a city", tools::makeWorkload(tools::OneMesh{}));
  measure(device, "boxes over a city",
          tools::makeWorkload(tools::OneMesh{.sensors = 512, .shape = tools::SensorShape::box}));
  measure(device, "teapots among 30000 boxes", tools::makeWorkload(tools::Table1{.boxes = 30'000, .sensors = 256}));
  measure(device, "boxes among 30000 boxes",
          tools::makeWorkload(tools::Table1{.boxes = 30'000, .sensors = 1024, .shape = tools::SensorShape::box}));
  measure(device, "Figure 7, 30 teapots", tools::makeWorkload(tools::Figure7{.teapots = 30, .steps = 1}));
  std::vector<tools::MeshData> meshes;
  std::vector<std::string> warnings;
  for (int i = 1; i < argc; ++i) meshes.push_back(tools::readMesh(argv[i], warnings));
  if (!meshes.empty()) {
    measure(device, "mesh files", tools::makeWorkload(tools::RandomPoses{.meshes = std::move(meshes)}));
  }
}
