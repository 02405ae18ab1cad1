// What a sensor costs as the world around it grows and its neighbourhood stays: 1,000 to 1,000,000 boxes at one
// density, and one mesh of 1 to 10 million triangles. Of all sizes in turn, so that a busy moment meets them alike;
// medians after a warm-up, without validation layers.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <deque>
#include <memory>
#include <string_view>

#include "commit/commit.h"
#include "radar/radar.h"
#include "reference/reference.h"
#include "workloads/generate.h"

namespace {

using namespace radar;
using Clock = std::chrono::steady_clock;

constexpr uint32_t kSensors = 1024;
// Of the sensors, by the reference and with pictures.
constexpr uint32_t kSome = 32;
constexpr int kRounds = 3;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

struct Run {
  double seconds = 0;
  SweepStats stats;
};

// A world of one size, on the device.
struct World {
  World(const Device& device, tools::Workload made, const std::string& label) : workload(std::move(made)), name(label) {
    const Clock::time_point built = Clock::now();
    player = std::make_unique<tools::ScenePlayer>(workload);
    player->show(0);
    const double buildSeconds = secondsSince(built);
    exact = std::make_unique<reference::Reference>(player->scene());
    sweeper = std::make_unique<Sweeper>(device, player->scene(), SweeperOptions{.timestamps = true});
    const Clock::time_point uploaded = Clock::now();
    sweeper->sync();
    std::printf("  %s: scene %.2f s, tree over objects and upload %.2f s\n", name.c_str(), buildSeconds,
                secondsSince(uploaded));
  }

  std::vector<Query> queries(Mode mode, uint32_t count) const {
    std::vector<Query> out;
    for (uint32_t i = 0; i < count; ++i) out.push_back(tools::toQuery(workload.queries[i], mode, 256));
    return out;
  }

  tools::Workload workload;
  std::string name;
  std::unique_ptr<tools::ScenePlayer> player;
  std::unique_ptr<reference::Reference> exact;
  std::unique_ptr<Sweeper> sweeper;
};

template <class RunOnce>
std::vector<Run> medians(std::deque<World>& worlds, const RunOnce& runOnce) {
  std::vector<std::vector<Run>> runs(worlds.size());
  for (int round = -1; round < kRounds; ++round) {  // the first is the warm-up
    for (size_t i = 0; i < worlds.size(); ++i) {
      const Clock::time_point start = Clock::now();
      const SweepStats stats = runOnce(worlds[i]);
      if (round >= 0) runs[i].push_back({secondsSince(start), stats});
    }
  }
  std::vector<Run> middle;
  for (std::vector<Run>& all : runs) {
    const auto at = all.begin() + kRounds / 2;
    std::nth_element(all.begin(), at, all.end(), [](const Run& a, const Run& b) { return a.seconds < b.seconds; });
    middle.push_back(*at);
  }
  return middle;
}

void print(const char* what, const std::deque<World>& worlds, const std::vector<Run>& runs, uint32_t sensors) {
  std::printf("  %s, %u sensors, us per sensor\n", what, sensors);
  for (size_t i = 0; i < worlds.size(); ++i) {
    const SweepStats& stats = runs[i].stats;
    std::printf("    %-20s %8.1f", worlds[i].name.c_str(), 1e6 * runs[i].seconds / sensors);
    const char* separator = "  (";
    for (const StageTime& stage : stats.stages) {
      std::printf("%s%s %.1f", separator, stage.name.c_str(), 1e3 * stage.ms / sensors);
      separator = " ";
    }
    const std::pair<const char*, uint64_t> counts[] = {{"triangles drawn", stats.drawnTriangles},
                                                       {"clusters", stats.clusters},
                                                       {"cluster pairs", stats.clusterPairs},
                                                       {"box tests", stats.pairs},
                                                       {"solves", stats.solves},
                                                       {"on the CPU", stats.cpuPairs}};
    separator = "; ";
    for (const auto& [name, count] : counts) {
      if (count == 0) continue;
      std::printf("%s%s %.1f", separator, name, double(count) / sensors);
      separator = ", ";
    }
    std::printf("%s\n", stats.stages.empty() ? "" : ")");
  }
  std::printf("    growth %.2f\n", runs.back().seconds / runs.front().seconds);
}

// `worlds`: ascending.
void measure(std::deque<World>& worlds) {
  for (const auto& [what, mode, count] :
       {std::tuple{"contact", Mode::contact, kSensors}, {"sampled at 256^2", Mode::sampled, kSome}}) {
    const auto runs = medians(worlds, [mode = mode, count = count](World& world) {
      world.sweeper->run(world.queries(mode, count));
      return world.sweeper->stats();
    });
    print(what, worlds, runs, count);
  }
  const auto runs = medians(worlds, [](World& world) {
    world.exact->run(world.queries(Mode::contact, kSome));
    return SweepStats();
  });
  print("reference on one thread", worlds, runs, kSome);
}

void growBoxes(const Device& device, tools::SensorShape shape) {
  std::deque<World> worlds;
  for (const uint32_t boxes : {1'000u, 10'000u, 100'000u, 1'000'000u}) {
    worlds.emplace_back(device, tools::makeWorkload(tools::Scale{.boxes = boxes, .sensors = kSensors, .shape = shape}),
                        std::to_string(boxes) + " boxes");
  }
  measure(worlds);
}

void growMesh(const Device& device, tools::SensorShape shape) {
  std::deque<World> worlds;
  for (const uint32_t triangles : {1'000'000u, 10'000'000u}) {
    worlds.emplace_back(
        device, tools::makeWorkload(tools::OneMesh{.triangles = triangles, .sensors = kSensors, .shape = shape}),
        std::to_string(triangles) + " triangles");
  }
  measure(worlds);
}

}  // namespace

// radar_bench_growth [boxes | mesh]: one half alone.
int main(int argc, char** argv) {
  const std::string_view only = argc > 1 ? argv[1] : "";
  const Device device = Device::open();
  std::printf("device %s, driver %s, commit %s\n", device.name().c_str(), device.driver().c_str(), tools::commit());
  for (const tools::SensorShape shape : {tools::SensorShape::box, tools::SensorShape::teapot}) {
    const char* sensors = shape == tools::SensorShape::box ? "box" : "teapot";
    if (only != "mesh") {
      std::printf("%s sensors among boxes\n", sensors);
      growBoxes(device, shape);
    }
    if (only != "boxes") {
      std::printf("%s sensors over one mesh\n", sensors);
      growMesh(device, shape);
    }
    std::fflush(stdout);
  }
}
