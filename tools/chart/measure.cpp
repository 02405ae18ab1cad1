#include "chart/measure.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <thread>

#include "bench/statistics.h"
#include "chart/in_child.h"
#include "radar/cpu_sweeper.h"

namespace radar::tools {

namespace {

// Of processor time, for a baseline to prepare itself and answer: a hull of many triangles takes minutes.
constexpr unsigned kMostSeconds = 25;

// A slow method gets so much more time, then fewer passes than it should.
constexpr double kPatience = 6;

// An error that is infinite is known all the same.
double finite(double length) {
  return std::min(std::abs(length), std::numeric_limits<double>::max());
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
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

std::vector<Instance> objectsOf(const Workload& workload, uint32_t scene) {
  const SceneSpec& spec = workload.scenes[scene];
  std::vector<Instance> objects;
  if (spec.base) objects = workload.scenes[*spec.base].instances;
  objects.insert(objects.end(), spec.instances.begin(), spec.instances.end());
  return objects;
}

// What the queries' masks leave out is excluded by name.
void unmask(std::vector<bench::Batch>& batches, const Workload& workload) {
  for (bench::Batch& batch : batches) {
    for (Query& query : batch.queries) {
      for (const auto& [object, bits] : workload.scenes[batch.scene].masks) {
        if ((bits & query.mask) == 0) query.exclude.push_back(object);
      }
    }
  }
}

// What a baseline tells: no bounds.
Result resultOf(double t) {
  Result result;
  result.status = std::isnan(t) ? Status::clear : Status::hit;
  result.t = t;
  result.lo = result.hi = NAN;
  return result;
}

// The numbers that a child hands over beside its answers.
std::array<double*, 6> timesOf(Cell& cell) {
  return {&cell.prepareMs, &cell.us, &cell.usLow, &cell.usHigh, &cell.cpuUs, &cell.sceneUs};
}

template <class Searcher>
bench::Method methodOf(ScenePlayer& player, Searcher& searcher) {
  return {"", [&](std::span<const Query> queries) { return searcher.run(queries); },
          [&](uint32_t scene) {
            player.show(scene);
            searcher.sync();
          }};
}

// The whole question, whatever the file says of modes.
std::vector<bench::Batch> batchesOf(const Workload& workload, Mode mode, uint32_t resolution) {
  std::vector<bench::Batch> batches = bench::batchesOf(workload, mode, resolution);
  for (bench::Batch& batch : batches) {
    for (Query& query : batch.queries) query.anyHit = false;
  }
  return batches;
}

// Fills the columns of time; returns the answers in the order of the batches.
std::vector<Result> timePasses(Cell& cell, const bench::Method& method, std::span<const bench::Batch> batches,
                               bench::Repetition repetition) {
  repetition.deadline = bench::Deadline(kPatience * repetition.seconds);
  const bench::Series series = bench::measure({&method, 1}, batches, repetition).front();
  const std::vector<double> times = bench::secondsOf(series.answer);
  const double perQuery = 1e6 / cell.queries;
  cell.passes = static_cast<uint32_t>(times.size());
  cell.us = perQuery * quantile(times, 0.5);
  cell.usLow = perQuery * quantile(times, 0.25);
  cell.usHigh = perQuery * quantile(times, 0.75);
  cell.cpuUs = perQuery * mean(bench::secondsOf(series.answer, &bench::Lap::process));
  cell.sceneUs = perQuery * mean(bench::secondsOf(series.prepare));
  return series.answers;
}

// The CPU's exact search, on cell.threads threads.
std::vector<Result> searchOnCpu(Cell& cell, const Workload& workload, const bench::Repetition& repetition) {
  cell.certified = true;
  const bench::Stopwatch stopwatch;
  ScenePlayer player(workload);
  player.show(0);
  CpuSweeper exact(player.scene(), cell.threads);
  exact.sync();
  cell.prepareMs = 1e3 * stopwatch.lap().wall;
  return timePasses(cell, methodOf(player, exact), batchesOf(workload, Mode::contact, 0), repetition);
}

// In cell.threads threads, each with a Baseline of its own.
std::vector<Result> cast(Cell& cell, const Workload& workload, const BaselineRow& row,
                         const bench::Repetition& repetition) {
  std::vector<bench::Batch> batches = batchesOf(workload, Mode::contact, 0);
  unmask(batches, workload);
  const bench::Stopwatch stopwatch;
  std::vector<std::unique_ptr<Baseline>> baselines;
  baselines.push_back(row.make(workload, cell.size));
  baselines[0]->show(objectsOf(workload, 0));
  cell.prepareMs = 1e3 * stopwatch.lap().wall;
  while (baselines.size() < cell.threads) baselines.push_back(row.make(workload, cell.size));
  const auto answer = [&](std::span<const Query> queries) {
    std::vector<Result> results(queries.size());
    inThreads(cell.threads, queries.size(), [&](uint32_t thread, size_t i) {
      results[i] = resultOf(baselines[thread]->cast(queries[i]).value_or(NAN));
    });
    return results;
  };
  std::optional<uint32_t> shown;
  const auto show = [&](uint32_t scene) {
    if (shown == scene) return;
    const std::vector<Instance> objects = objectsOf(workload, scene);
    for (const std::unique_ptr<Baseline>& baseline : baselines) baseline->show(objects);
    shown = scene;
  };
  return timePasses(cell, {cell.method, answer, show}, batches, repetition);
}

// The same in a process of its own. Where the library ends it, Cell::failed says how.
std::vector<Result> castInChild(Cell& cell, const Workload& workload, const BaselineRow& row,
                                const bench::Repetition& repetition) {
  const auto work = [&] {
    const std::vector<Result> results = cast(cell, workload, row, repetition);
    std::vector<double> values{static_cast<double>(cell.passes)};
    for (const double* time : timesOf(cell)) values.push_back(*time);
    for (const Result& result : results) values.push_back(result.t);
    return values;
  };
  const ChildOutcome outcome = inChild(work, kMostSeconds);
  cell.failed = outcome.failed;
  if (!cell.failed.empty()) return {};
  auto next = outcome.values.begin();
  cell.passes = static_cast<uint32_t>(*next++);
  for (double* time : timesOf(cell)) *time = *next++;
  std::vector<Result> results;
  std::transform(next, outcome.values.end(), std::back_inserter(results), resultOf);
  return results;
}

}  // namespace

void judge(Cell& cell, std::span<const Claim> claims, std::span<const Result> truth, std::span<const double> sizes) {
  std::vector<double> errors, widths;
  for (size_t i = 0; i < claims.size(); ++i) {
    const Verdict verdict = judge(claims[i], truth[i], sizes[i]);
    const bool isBounded = !std::isnan(claims[i].hi);
    cell.contacts += meets(truth[i]);
    cell.found += verdict.found;
    cell.misses += verdict[Fault::missed] || verdict.unseen;
    cell.falseHits += verdict[Fault::falseHit];
    cell.violations += verdict[Fault::bracket] || (verdict[Fault::falseHit] && isBounded) ||
                       (verdict[Fault::missed] && cell.certified);
    if (!verdict.found) continue;
    errors.push_back(finite(verdict.error));
    if (cell.certified) widths.push_back(finite((claims[i].hi - claims[i].lo) / sizes[i]));
  }
  cell.errorMedian = quantile(errors, 0.5);
  cell.error99 = quantile(errors, 0.99);
  cell.errorWorst = quantile(errors, 1);
  cell.widthWorst = quantile(widths, 1);
}

struct Bench::Engine {
  Engine(const Workload& workload, const Device& device, const SweeperOptions& given)
      : options(given), player(workload), sweeper(device, player.scene(), given) {
    player.show(0);
    sweeper.sync();
    prepareMs = 1e3 * stopwatch.lap().wall;
  }

  bench::Stopwatch stopwatch;
  double prepareMs = 0;
  SweeperOptions options;
  ScenePlayer player;
  Sweeper sweeper;
};

Bench::Bench(const Case& which, const Device& device, const bench::Repetition& repetition)
    : which_(which), device_(device), repetition_(repetition) {
  ScenePlayer player(which.workload);
  CpuSweeper exact(player.scene());
  const std::vector<bench::Batch> batches = batchesOf(which.workload, Mode::contact, 0);
  truth_ = bench::play(methodOf(player, exact), batches).answers;
  for (const bench::Batch& batch : batches) {
    for (const Query& query : batch.queries) {
      const double size = sensorSize(player.scene(), query);
      sizes_.push_back(size > 0 ? size : 1);
    }
  }
}

Bench::~Bench() = default;

Cell Bench::measure(const Method& method, const BaselineRow* row) {
  Cell cell;
  cell.section = which_.section;
  cell.workload = which_.name;
  cell.x = which_.x;
  cell.method = method.name();
  cell.family = method.family;
  cell.size = method.size;
  cell.threads = method.threads;
  cell.queries = static_cast<uint32_t>(which_.workload.queries.size());
  const std::vector<Result> results = row != nullptr ? castInChild(cell, which_.workload, *row, repetition_)
                                      : method.family == "reference" ? searchOnCpu(cell, which_.workload, repetition_)
                                                                     : sweep(cell);
  if (!cell.failed.empty()) return cell;
  std::vector<Claim> claims(results.size());
  std::transform(results.begin(), results.end(), claims.begin(), claimOf);
  judge(cell, claims, truth_, sizes_);
  return cell;
}

std::vector<Result> Bench::sweep(Cell& cell) {
  const Mode mode = cell.family.starts_with("contact") ? Mode::contact : Mode::sampled;
  cell.certified = mode != Mode::sampled;
  const SweeperOptions options{.select = cell.family != "drawing all",
                               .cpuBatch = cell.family == "contact on device" ? 0 : kNone};
  if (!engine_ || engine_->options.select != options.select || engine_->options.cpuBatch != options.cpuBatch) {
    engine_ = std::make_unique<Engine>(which_.workload, device_, options);
  }
  cell.prepareMs = engine_->prepareMs;
  return timePasses(cell, methodOf(engine_->player, engine_->sweeper), batchesOf(which_.workload, mode, cell.size),
                    repetition_);
}

}  // namespace radar::tools
