#include <algorithm>
#include <map>
#include <memory>
#include <optional>

#include "measure/case_run.h"
#include "measure/selftest.h"
#include "radar/cpu_sweeper.h"
#include "radar/pool.h"
#include "workloads/generate.h"

namespace radar::tools {

namespace {

constexpr SweeperOptions kOnDevice{.cpuBatch = 0};
constexpr uint32_t kDistinct = 16'384;  // queries that are not repeated in a batch, where it is that large

Workload lightWorkload() {
  return makeWorkload(Table1{.boxes = 30'000, .sensors = kDistinct, .shape = SensorShape::box});
}
// The light one for each kind of query that a Sweeper's choice of a side tells apart.
Workload nearWorkload() {
  Workload workload = lightWorkload();
  for (QuerySpec& query : workload.queries) query.clearance = 0.1;
  return workload;
}
Workload listWorkload() {
  Workload workload = lightWorkload();
  for (QuerySpec& query : workload.queries) query.hits = kAllHits;
  return workload;
}
Workload heavyWorkload() {
  return makeWorkload(Table1{.boxes = 10'000, .sensors = kDistinct, .shape = SensorShape::teapot});
}

// A scene that stands, and a batch of queries in it.
struct Standing {
  explicit Standing(const Workload& workload) : player(workload), batch(batchesOf(workload.queries).front()) {
    player.show(batch.scene);
  }
  // So many queries: the first ones, over and over where there are fewer.
  Batch repeated(uint64_t count) const {
    Batch many{.scene = batch.scene};
    many.queries.reserve(count);
    for (uint64_t i = 0; i < count; ++i) many.queries.push_back(batch.queries[i % batch.queries.size()]);
    return many;
  }
  const Scene& scene() const { return player.scene(); }

  ScenePlayer player;
  Batch batch;
};

double medianUs(const std::vector<Lap>& laps, uint64_t queries) {
  return 1e6 * median(secondsOf(laps)) / static_cast<double>(queries);
}

// The device's search and the CPU's, side by side.
class Race {
 public:
  /// Answers the first queries of a batch, so that what is done once, such as compiling shaders, is no part of a time.
  Race(const Device& device, const Scene& scene, std::span<const Query> batch)
      : sweeper_(device, scene, kOnDevice), cpu_(scene) {
    constexpr size_t kMost = 256;
    sweeper_.run(batch.first(std::min(batch.size(), kMost)));
    cpu_.run(batch.first(std::min(batch.size(), kMost)));
  }

  /// At least one pass, and as many as fit into half a second, up to nine. `batches` are played by showing their scenes
  /// with `show`, which is part of the time. Returns the microseconds that a query took on both together.
  double measure(
      const char* workload, std::span<const Batch> batches, const Deadline& deadline, Json& rows,
      const std::function<void(uint32_t)>& show = [](uint32_t) {}) {
    const std::vector<Session> methods{{"device", [&](auto queries) { return resultsOf(sweeper_.run(queries)); }, show},
                                       {"CPU", [&](auto queries) { return cpu_.run(queries).results; }, show}};
    const std::vector<Series> all =
        tools::measure(methods, batches, {.warmUps = 0, .least = 1, .most = 9, .seconds = 0.5, .deadline = deadline});
    const auto us = [](const Series& series) {
      std::vector<Lap> laps = series.answer;
      for (size_t i = 0; i < laps.size(); ++i) laps[i] += series.show[i];
      return medianUs(laps, series.answers.size());
    };
    const double device = us(all[0]), cpu = us(all[1]);
    rows.push_back({{"workload", workload},
                    {"batch", all[0].answers.size() / batches.size()},
                    {"device_us_per_query", device},
                    {"cpu_us_per_query", cpu},
                    {"device_per_s", 1e6 / device},
                    {"cpu_per_s", 1e6 / cpu},
                    {"cpu_over_device", cpu / device},
                    {"differ", all[1].differ}});
    return device + cpu;
  }

 private:
  Sweeper sweeper_;
  CpuSweeper cpu_;
};

// Whether so many queries fit in what is left, at so many microseconds each. The first batch always does.
bool fits(const Json& rows, double us, uint64_t queries, const Deadline& deadline) {
  return rows.empty() || (!deadline.isOver() && 1e-6 * us * static_cast<double>(queries) < deadline.left());
}

bool measureStanding(const Device& device, const char* name, const Workload& workload, const Deadline& deadline,
                     Json& rows) {
  const Standing standing(workload);
  Race race(device, standing.scene(), standing.batch.queries);
  double us = 0;
  for (uint64_t size = 1; size <= 1'000'000; size *= 10) {
    if (!fits(rows, us, size, deadline)) return false;
    const Batch batch = standing.repeated(size);
    us = race.measure(name, {&batch, 1}, deadline, rows);
  }
  return true;
}

bool measureMoving(const Device& device, const Deadline& deadline, Json& rows) {
  constexpr uint32_t kSteps = 4;
  double us = 0;
  for (const uint32_t teapots : {10u, 30u, 100u, 300u, 1'000u}) {
    // The more there are, the more each meets: three times as many cost each up to three times as much.
    if (!fits(rows, us, uint64_t{3} * kSteps * teapots, deadline)) return false;
    const Workload workload = makeWorkload(Figure7{.teapots = teapots, .boxes = 10'000, .steps = kSteps});
    const std::vector<Batch> batches = batchesOf(workload.queries);
    ScenePlayer player(workload);
    player.show(batches[0].scene);
    us = Race(device, player.scene(), batches[0].queries)
             .measure("moving", batches, deadline, rows, [&](uint32_t scene) { player.show(scene); });
  }
  return true;
}

// Medians of each stage over some runs, and of what the calling thread saw.
bool addStages(const Device& device, const char* name, const Workload& workload, Mode mode, const Deadline& deadline,
               Json& rows) {
  const Standing standing(workload);
  const uint64_t queries = standing.batch.queries.size();
  Sweeper sweeper(device, standing.scene(), {.timestamps = true, .cpuBatch = 0});
  std::vector<Lap> laps;
  std::map<std::string, std::vector<double>> times;
  std::vector<std::string> order;
  inTurns({.least = 5, .most = 5, .deadline = deadline}, 1, [&](size_t, bool counts) {
    Answers answers;
    const Lap lap = lapOf([&] { answers = sweeper.run(standing.batch.queries, mode); });
    if (!counts) return;
    laps.push_back(lap);
    for (const StageTime& stage : answers.stats.stages) {
      if (!times.contains(stage.name)) order.push_back(stage.name);
      times[stage.name].push_back(stage.ms);
    }
  });
  const auto add = [&](const std::string& stage, double us) {
    rows.push_back({{"workload", name}, {"stage", stage}, {"us_per_query", us}});
  };
  for (const std::string& stage : order) add(stage, 1e3 * median(times[stage]) / static_cast<double>(queries));
  add("all, as the caller sees it", medianUs(laps, queries));
  return laps.size() == 5;
}

constexpr uint32_t kInFlight = 4;  // batches that a lane is given at once

Session laneOf(const std::string& name, Pool& pool) {
  return {name, [&pool](std::span<const Query> queries) {
            std::vector<std::future<PoolAnswers>> answers;
            for (uint32_t i = 0; i < kInFlight; ++i) answers.push_back(pool.submit({queries.begin(), queries.end()}));
            for (uint32_t i = 1; i < kInFlight; ++i) answers[i].get();
            return answers[0].get().results;
          }};
}

bool addLanes(const std::vector<Session>& lanes, const Batch& batch, const Deadline& deadline, Json& rows) {
  double first = 0;
  const std::vector<Series> all = tools::measure(lanes, {&batch, 1}, {.least = 3, .most = 3, .deadline = deadline});
  for (size_t i = 0; i < lanes.size(); ++i) {
    if (all[i].differ > 0) throw Error(lanes[i].name + ": other answers than " + lanes[0].name);
    const double us = medianUs(all[i].answer, kInFlight * batch.queries.size());
    if (i == 0) first = us;
    rows.push_back({{"way", lanes[i].name}, {"us_per_query", us}, {"times_as_fast", first / us}});
  }
  return !deadline.isOver();
}

bool measureArithmetic(std::span<const Device> devices, std::span<const uint32_t>, const Deadline&, Json& rows) {
  for (const ArithmeticCheck& check : checkArithmetic(devices[0])) {
    rows.push_back({{"operation", check.operation},
                    {"passed", check.passed()},
                    {"tried", check.tried},
                    {"wrong_results", check.wrong},
                    {"worst_ulps", check.worst},
                    {"needed", check.needed},
                    {"if_wrong", check.ifWrong}});
  }
  return true;
}

bool measureKernels(std::span<const Device>, std::span<const uint32_t> numbers, const Deadline&, Json& rows) {
  for (const KernelReport& kernel : compileKernels(numbers[0])) {
    std::string statistics;
    for (const auto& [name, description, value] : kernel.statistics) {
      statistics += (statistics.empty() ? "" : ", ") + name + " " + std::to_string(std::llround(value));
    }
    rows.push_back({{"kernel", kernel.name}, {"ms", kernel.milliseconds}, {"statistics", statistics}});
  }
  return true;
}

// Queries of every kind, also those that a renderer records, with its geometry, in scenes that other seeds decide than
// those by which a device proves itself.
bool measureAnswers(std::span<const Device> devices, std::span<const uint32_t>, const Deadline& deadline, Json& rows) {
  constexpr uint64_t kFirst = 2, kScenes = 100;
  for (uint64_t seed = kFirst; seed < kFirst + kScenes; ++seed) {
    if (deadline.isOver() && !rows.empty()) return false;
    const std::vector<AnswerCheck> checks = checkAnswers(devices[0], seed);
    for (size_t i = 0; i < checks.size(); ++i) {
      const AnswerCheck& check = checks[i];
      if (rows.size() == i) {
        rows.push_back(
            {{"kind", check.kind}, {"scenes", 0}, {"queries", 0}, {"wrong", 0}, {"stage", ""}, {"first_wrong", ""}});
      }
      Json& row = rows[i];
      row["scenes"] = row["scenes"].get<uint64_t>() + 1;
      row["queries"] = row["queries"].get<uint64_t>() + check.asked;
      row["wrong"] = row["wrong"].get<uint64_t>() + check.wrong;
      if (row["first_wrong"] == "" && !check.passed()) {
        row["stage"] = check.stage;
        row["first_wrong"] = "seed " + std::to_string(seed) + ", " + check.firstWrong;
      }
    }
  }
  return true;
}

// Random queries of all families in turn, with doubles where the device has them and without, until the time is up.
// Returns true once every family has been asked.
bool measureExactness(std::span<const Device> devices, std::span<const uint32_t> numbers, const Deadline& deadline,
                      Json& rows) {
  const Device& device = devices[0];
  constexpr uint64_t kAtOnce = 64;
  const std::vector<std::string> families = runFamilies();
  std::optional<Device> withoutDoubles;
  std::vector<std::unique_ptr<CaseRun>> variants(device.doubles() ? 2 : 1);
  for (uint64_t round = 0;; ++round) {
    for (size_t v = 0; v < variants.size(); ++v) {
      if (!variants[v]) {
        if (v == 1) withoutDoubles.emplace(Device::open({.index = numbers[0], .doubles = false}));
        variants[v] = std::make_unique<CaseRun>(v == 0 ? device : *withoutDoubles);
      }
      for (size_t f = 0; f < families.size(); ++f) {
        if (deadline.isOver() && !rows.empty()) return round > 0;
        if (round == 0) {
          rows.push_back({{"family", families[f]}, {"doubles", v == 0 && device.doubles()}, {"first_wrong", ""}});
        }
        Json& row = rows[v * families.size() + f];
        const auto onWrong = [&](uint64_t query, const Approach&, const std::string& words) {
          if (row["first_wrong"] == "") row["first_wrong"] = "query " + std::to_string(query) + ": " + words;
        };
        const Tally tally = variants[v]->run({families[f], 1, round * kAtOnce, kAtOnce}, onWrong);
        for (const auto& [name, count] :
             {std::pair("queries", tally.queries), std::pair("hits", tally.hits), std::pair("clear", tally.clear),
              std::pair("overlaps", tally.overlaps), std::pair("wrong", tally.wrong), std::pair("pairs", tally.pairs),
              std::pair("cpu_pairs", tally.cpuPairs)}) {
          row[name] = row.value(name, uint64_t{0}) + count;
        }
      }
    }
  }
}

// Batches of 1 to 10^6 small sensors among 30,000 boxes (light), with a clearance, with lists of all contacts, of
// teapots (heavy), and of teapots that all move from batch to batch (moving; D 15, the scene's changes in the time).
bool measureThroughput(std::span<const Device> devices, std::span<const uint32_t>, const Deadline& deadline,
                       Json& rows) {
  bool whole = true;
  double share = 5;
  for (const auto& [name, make] : {std::pair("light", &lightWorkload), std::pair("heavy", &heavyWorkload),
                                   std::pair("clearance", &nearWorkload), std::pair("lists", &listWorkload)}) {
    // What one workload does not use is left to the next.
    const Deadline own(deadline.left() / share--);
    whole &= measureStanding(devices[0], name, make(), own, rows);
  }
  return measureMoving(devices[0], deadline, rows) && whole;
}

// Where the time of batches of 16,384 goes in the exact search.
bool measureStages(std::span<const Device> devices, std::span<const uint32_t>, const Deadline& deadline, Json& rows) {
  const bool light = addStages(devices[0], "light", lightWorkload(), Mode::contact, deadline, rows);
  return addStages(devices[0], "heavy", heavyWorkload(), Mode::contact, deadline, rows) && light;
}

// Where the time goes in the paper's method.
bool measurePasses(std::span<const Device> devices, std::span<const uint32_t>, const Deadline& deadline, Json& rows) {
  return addStages(devices[0], "256 teapots among 10,000 boxes",
                   makeWorkload(Table1{.boxes = 10'000, .sensors = 256, .shape = SensorShape::teapot}), Mode::sampled,
                   deadline, rows);
}

// One batch after the other, beside two in flight.
bool measureLanes(std::span<const Device> devices, std::span<const uint32_t>, const Deadline& deadline, Json& rows) {
  const Workload workload = lightWorkload();
  const Standing standing(workload);
  // One thread at a time uses the queue: the pool sleeps while the sweeper runs.
  Sweeper sweeper(devices[0], standing.scene(), kOnDevice);
  Pool pool(devices, standing.scene(), kOnDevice);
  const auto oneByOne = [&](std::span<const Query> queries) {
    for (uint32_t i = 1; i < kInFlight; ++i) sweeper.run(queries);
    return resultsOf(sweeper.run(queries));
  };
  return addLanes({{"a Sweeper: one batch after the other", oneByOne}, laneOf("a Pool: two batches in flight", pool)},
                  standing.batch, deadline, rows);
}

// Every device alone, then all of them.
bool measureTogether(std::span<const Device> devices, std::span<const uint32_t> numbers, const Deadline& deadline,
                     Json& rows) {
  const Workload workload = lightWorkload();
  const Standing standing(workload);
  std::vector<std::unique_ptr<Pool>> pools;
  std::vector<Session> lanes;
  const auto add = [&](const std::string& name, std::span<const Device> some) {
    pools.push_back(std::make_unique<Pool>(some, standing.scene(), kOnDevice));
    lanes.push_back(laneOf(name, *pools.back()));
  };
  for (size_t i = 0; i < devices.size(); ++i) {
    add("device " + std::to_string(numbers[i]) + " alone", devices.subspan(i, 1));
  }
  add("all " + std::to_string(devices.size()) + " devices", devices);
  return addLanes(lanes, standing.batch, deadline, rows);
}

constexpr SelftestPart kParts[] = {
    {"arithmetic", "Arithmetic, on which the bounds rest", 0.01, measureArithmetic},
    {"kernels", "Kernels, as the device's compiler makes them", 0.01, measureKernels},
    {"answers", "Known queries of every kind, those of a renderer's frames among them", 0.04, measureAnswers},
    {"throughput", "Throughput of the device, and of all cores of the CPU", 0.4, measureThroughput},
    {"stages", "Stages of mode contact, batches of 16,384", 0.07, measureStages},
    {"lanes", "Batches in flight", 0.07, measureLanes},
    {"passes", "Passes of mode sampled", 0.07, measurePasses, SelftestPart::eachSampled},
    {"together", "All devices together", 0.09, measureTogether, SelftestPart::together},
    {"exactness", "Random queries of every family, compared with the CPU's answers", 0.25, measureExactness}};

}  // namespace

std::span<const SelftestPart> selftestParts() {
  return kParts;
}

}  // namespace radar::tools
