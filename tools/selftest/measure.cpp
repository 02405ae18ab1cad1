#include "selftest/measure.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "report/median.h"
#include "workloads/generate.h"
#include "workloads/same_answer.h"

namespace radar::tools {

namespace {

using Clock = std::chrono::steady_clock;

constexpr SweeperOptions kOnDevice{.cpuBatch = 0};
constexpr uint32_t kDistinct = 16'384;  // queries that are not repeated in a batch, where it is that large

double secondsOf(const std::function<void()>& work) {
  const Clock::time_point start = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// The first `count` queries of one scene's, over and over.
std::vector<Query> repeated(const std::vector<Query>& queries, uint64_t count) {
  std::vector<Query> all;
  all.reserve(count);
  for (uint64_t i = 0; i < count; ++i) all.push_back(queries[i % queries.size()]);
  return all;
}

std::vector<Query> queriesOf(const Workload& workload, Mode mode, uint32_t scene) {
  std::vector<Query> queries;
  for (const QuerySpec& spec : workload.queries) {
    if (spec.scene == scene) queries.push_back(toQuery(spec, mode));
  }
  return queries;
}

Workload lightWorkload() {
  return makeWorkload(Table1{.boxes = 30'000, .sensors = kDistinct, .shape = SensorShape::box});
}
Workload heavyWorkload() {
  return makeWorkload(Table1{.boxes = 10'000, .sensors = kDistinct, .shape = SensorShape::teapot});
}

// A batch, asked of the device's search and of the CPU's in turn.
class Race {
 public:
  using Run = std::function<std::vector<Result>()>;

  Race(Run device, Run cpu) : ways_{std::move(device), std::move(cpu)} {}

  /// At least one round, and as many as fit into half a second, up to nine.
  ThroughputRow measure(const char* workload, uint64_t queries, const Deadline& deadline) {
    ThroughputRow row{workload, queries, 0, 0, 0};
    std::vector<double> seconds[2];
    double spent = 0;
    for (int round = 0; round < 9 && (round == 0 || (spent < 0.5 && !deadline.isOver())); ++round) {
      std::vector<Result> answers[2];
      for (int way = 0; way < 2; ++way) {
        const double took = secondsOf([&] { answers[way] = ways_[way](); });
        // What is done once is no part of a small batch's time.
        if (round == 1 && seconds[way].size() == 1) seconds[way].clear();
        seconds[way].push_back(took);
        spent += took;
      }
      for (size_t i = 0; i < answers[0].size(); ++i) row.differ += sameAnswer(answers[0][i], answers[1][i]) ? 0 : 1;
    }
    const auto us = [&](int way) { return 1e6 * median(seconds[way]) / static_cast<double>(queries); };
    row.deviceUs = us(0);
    row.cpuUs = us(1);
    return row;
  }

 private:
  Run ways_[2];
};

// Whether so many queries, at the pace of the last batch, fit in what is left.
bool fits(const std::vector<ThroughputRow>& rows, const char* workload, uint64_t queries, const Deadline& deadline) {
  if (rows.empty()) return true;
  if (deadline.isOver()) return false;
  if (rows.back().workload != workload) return true;
  const double us = rows.back().deviceUs + rows.back().cpuUs;
  return 1e-6 * us * static_cast<double>(queries) < deadline.left();
}

bool measureStanding(const Device& device, const char* name, const Workload& workload, const Deadline& deadline,
                     std::vector<ThroughputRow>& rows) {
  ScenePlayer player(workload);
  player.show(0);
  const std::vector<Query> distinct = queriesOf(workload, Mode::contact, 0);
  Sweeper sweeper(device, player.scene(), kOnDevice);
  CpuSweeper cpu(player.scene());
  for (uint64_t batch = 1; batch <= 1'000'000; batch *= 10) {
    if (!fits(rows, name, batch, deadline)) return false;
    const std::vector<Query> queries = repeated(distinct, batch);
    rows.push_back(
        Race([&] { return sweeper.run(queries); }, [&] { return cpu.run(queries); }).measure(name, batch, deadline));
  }
  return true;
}

bool measureMoving(const Device& device, const char* name, const Deadline& deadline, std::vector<ThroughputRow>& rows) {
  constexpr uint32_t kSteps = 4;
  for (const uint32_t teapots : {10u, 30u, 100u, 300u, 1'000u}) {
    // The more there are, the more each meets: three times as many cost each up to three times as much.
    if (!fits(rows, name, uint64_t{3} * kSteps * teapots, deadline)) return false;
    const Workload workload = makeWorkload(Figure7{.teapots = teapots, .boxes = 10'000, .steps = kSteps});
    const std::vector<Batch> batches = batchesOf(workload);
    ScenePlayer player(workload);
    player.show(batches[0].scene);
    Sweeper sweeper(device, player.scene(), kOnDevice);
    CpuSweeper cpu(player.scene());
    // The two play the scene in turn, each all of its steps.
    const auto play = [&](const auto& run) {
      std::vector<Result> answers;
      for (const Batch& batch : batches) {
        player.show(batch.scene);
        const std::vector<Result> found = run(queriesOf(workload, Mode::contact, batch.scene));
        answers.insert(answers.end(), found.begin(), found.end());
      }
      return answers;
    };
    ThroughputRow row = Race([&] { return play([&](const auto& batch) { return sweeper.run(batch); }); },
                             [&] { return play([&](const auto& batch) { return cpu.run(batch); }); })
                            .measure(name, workload.queries.size(), deadline);
    row.batch = teapots;
    rows.push_back(row);
  }
  return true;
}

// Medians of each stage over some runs, and of what the calling thread saw.
bool addStages(const Device& device, const char* name, const Workload& workload, Mode mode, uint64_t batch,
               const Deadline& deadline, std::vector<StageRow>& rows) {
  ScenePlayer player(workload);
  player.show(0);
  const std::vector<Query> queries = repeated(queriesOf(workload, mode, 0), batch);
  Sweeper sweeper(device, player.scene(), {.timestamps = true, .cpuBatch = 0});
  sweeper.run(queries);
  std::vector<double> wall;
  std::map<std::string, std::vector<double>> times;
  std::vector<std::string> order;
  for (int i = 0; i < 5 && (i == 0 || !deadline.isOver()); ++i) {
    wall.push_back(secondsOf([&] { sweeper.run(queries); }));
    for (const StageTime& stage : sweeper.stats().stages) {
      if (!times.contains(stage.name)) order.push_back(stage.name);
      times[stage.name].push_back(stage.ms);
    }
  }
  const auto perQuery = [&](double seconds) { return 1e6 * seconds / static_cast<double>(batch); };
  for (const std::string& stage : order) rows.push_back({name, stage, perQuery(1e-3 * median(times[stage]))});
  rows.push_back({name, "all, as the caller sees it", perQuery(median(wall))});
  return wall.size() == 5;
}

double usOfPool(Pool& pool, const std::vector<Query>& queries, const Deadline& deadline) {
  constexpr int kBatches = 4;
  std::vector<double> seconds;
  for (int round = -1; round < 3 && (round < 1 || !deadline.isOver()); ++round) {
    const double took = secondsOf([&] {
      std::vector<std::future<PoolAnswers>> answers;
      for (int i = 0; i < kBatches; ++i) answers.push_back(pool.submit(queries));
      for (std::future<PoolAnswers>& one : answers) one.get();
    });
    if (round >= 0) seconds.push_back(took);
  }
  return 1e6 * median(seconds) / static_cast<double>(kBatches * queries.size());
}

}  // namespace

bool measureExactness(const Device& device, uint32_t number, const Deadline& deadline,
                      std::vector<ExactnessRow>& rows) {
  constexpr uint64_t kAtOnce = 64;
  struct Variant {
    bool doubles;
    std::optional<Device> own;
    std::unique_ptr<RandomQueries> asking;
  };
  std::vector<Variant> variants(device.doubles() ? 2 : 1);
  variants[0].doubles = device.doubles();
  variants[0].asking = std::make_unique<RandomQueries>(device);
  const std::vector<std::string> families = randomFamilies();
  for (uint64_t round = 0;; ++round) {
    for (size_t v = 0; v < variants.size(); ++v) {
      Variant& variant = variants[v];
      if (!variant.asking) {
        variant.doubles = false;
        variant.own.emplace(Device::open({.index = number, .doubles = false}));
        variant.asking = std::make_unique<RandomQueries>(*variant.own);
      }
      for (size_t f = 0; f < families.size(); ++f) {
        if (deadline.isOver() && !rows.empty()) return round > 0;
        if (round == 0) rows.push_back({families[f], variant.doubles, {}});
        rows[v * families.size() + f].tally.add(variant.asking->run(
            {families[f], 1, round * kAtOnce, kAtOnce}, [](uint64_t, const std::string&) {}, [](uint64_t) {}));
      }
    }
  }
}

bool measureThroughput(const Device& device, const Deadline& deadline, std::vector<ThroughputRow>& rows) {
  // What one workload does not use is left to the next.
  const Deadline first(deadline.left() / 3);
  bool whole = measureStanding(device, "light", lightWorkload(), first, rows);
  const Deadline second(deadline.left() / 2);
  whole &= measureStanding(device, "heavy", heavyWorkload(), second, rows);
  return measureMoving(device, "moving", deadline, rows) && whole;
}

bool measureStages(const Device& device, const Deadline& deadline, std::vector<StageRow>& rows) {
  const bool light = addStages(device, "light", lightWorkload(), Mode::contact, kDistinct, deadline, rows);
  return addStages(device, "heavy", heavyWorkload(), Mode::contact, kDistinct, deadline, rows) && light;
}

bool measureLanes(const Device& device, const Deadline& deadline, std::vector<LaneRow>& rows) {
  const Workload workload = lightWorkload();
  ScenePlayer player(workload);
  player.show(0);
  const std::vector<Query> queries = queriesOf(workload, Mode::contact, 0);
  {
    Sweeper sweeper(device, player.scene(), kOnDevice);
    std::vector<double> seconds;
    for (int i = -1; i < 5 && (i < 1 || !deadline.isOver()); ++i) {
      const double took = secondsOf([&] { sweeper.run(queries); });
      if (i >= 0) seconds.push_back(took);
    }
    rows.push_back({"a Sweeper: one batch after the other", 1e6 * median(seconds) / kDistinct, 1});
  }
  Pool pool({&device, 1}, player.scene(), kOnDevice);
  const double us = usOfPool(pool, queries, deadline);
  rows.push_back({"a Pool: two batches in flight", us, rows[0].us / us});
  return !deadline.isOver();
}

bool measurePasses(const Device& device, const Deadline& deadline, std::vector<StageRow>& rows) {
  return addStages(device, "256 teapots among 10,000 boxes",
                   makeWorkload(Table1{.boxes = 10'000, .sensors = 256, .shape = SensorShape::teapot}), Mode::sampled,
                   256, deadline, rows);
}

bool measureTogether(const std::vector<Device>& devices, const std::vector<uint32_t>& numbers, const Deadline& deadline,
                     std::vector<LaneRow>& rows) {
  const Workload workload = lightWorkload();
  ScenePlayer player(workload);
  player.show(0);
  const std::vector<Query> queries = queriesOf(workload, Mode::contact, 0);
  const auto add = [&](const std::string& way, std::span<const Device> some) {
    Pool pool(some, player.scene(), kOnDevice);
    const double us = usOfPool(pool, queries, deadline);
    rows.push_back({way, us, rows.empty() ? 1 : rows[0].us / us});
  };
  for (size_t i = 0; i < devices.size(); ++i) {
    add("device " + std::to_string(numbers[i]) + " alone", std::span(devices).subspan(i, 1));
  }
  add("all " + std::to_string(devices.size()) + " devices", devices);
  return !deadline.isOver();
}

}  // namespace radar::tools
