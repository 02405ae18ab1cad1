
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <thread>

#include "bench/harness.h"
#include "bench/statistics.h"
#include "chart/run.h"
#include "child/in_child.h"
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
void unmask(std::vector<Batch>& batches, const Workload& workload) {
  for (Batch& batch : batches) {
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

// The whole question, whatever the file says of modes.
std::vector<Batch> batchesOf(const Workload& workload, uint32_t resolution = 0) {
  std::vector<Batch> batches = tools::batchesOf(workload.queries, resolution);
  for (Batch& batch : batches) {
    for (Query& query : batch.queries) query.anyHit = false;
  }
  return batches;
}

// Fills the columns of time; returns the answers in the order of the batches.
std::vector<Result> timePasses(Cell& cell, const bench::Method& method, std::span<const Batch> batches,
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

// Ours. `make` makes what answers in a scene, and `ask` asks it.
template <class Make, class Ask>
std::vector<Result> search(Cell& cell, const Workload& workload, const bench::Repetition& repetition, const Make& make,
                           const Ask& ask) {
  const bench::Stopwatch stopwatch;
  ScenePlayer player(workload);
  auto searcher = make(player.scene());
  const auto show = [&](uint32_t scene) {
    player.show(scene);
    searcher.sync();
  };
  show(0);
  cell.prepareMs = 1e3 * stopwatch.lap().wall;
  const auto answer = [&](std::span<const Query> queries) { return ask(searcher, queries).results; };
  return timePasses(cell, {cell.method, answer, show}, batchesOf(workload, cell.size), repetition);
}

std::vector<Result> searchOnCpu(Cell& cell, const Workload& workload, const bench::Repetition& repetition) {
  cell.certified = true;
  return search(
      cell, workload, repetition, [&](const Scene& scene) { return CpuSweeper(scene, cell.threads); },
      [](CpuSweeper& cpu, std::span<const Query> queries) { return cpu.run(queries); });
}

std::vector<Result> searchOnDevice(Cell& cell, const Workload& workload, const bench::Repetition& repetition,
                                   const Device& device) {
  const SweeperOptions options{.select = cell.family != "drawing all",
                               .cpuBatch = cell.family == "contact on device" ? 0 : kNone};
  const Mode mode = cell.family.starts_with("contact") ? Mode::contact : Mode::sampled;
  cell.certified = mode == Mode::contact;
  return search(
      cell, workload, repetition, [&](const Scene& scene) { return Sweeper(device, scene, options); },
      [mode](Sweeper& sweeper, std::span<const Query> queries) { return sweeper.run(queries, mode); });
}

// In cell.threads threads, each with a Baseline of its own.
std::vector<Result> cast(Cell& cell, const Workload& workload, const BaselineRow& row,
                         const bench::Repetition& repetition) {
  std::vector<Batch> batches = batchesOf(workload);
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
    return std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double));
  };
  const ChildOutcome outcome = inChild(work, {.seconds = kMostSeconds});
  cell.failed = outcome.failed;
  if (!cell.failed.empty()) return {};
  std::vector<double> values(outcome.bytes.size() / sizeof(double));
  std::memcpy(values.data(), outcome.bytes.data(), values.size() * sizeof(double));
  auto next = values.begin();
  cell.passes = static_cast<uint32_t>(*next++);
  for (double* time : timesOf(cell)) *time = *next++;
  std::vector<Result> results;
  std::transform(next, values.end(), std::back_inserter(results), resultOf);
  return results;
}

// The sensors' sizes, in the order of the batches.
std::vector<double> sizesOf(const Workload& workload) {
  ScenePlayer player(workload);
  std::vector<double> sizes;
  for (const Batch& batch : batchesOf(workload)) {
    for (const Query& query : batch.queries) {
      const double size = sensorSize(player.scene(), query);
      sizes.push_back(size > 0 ? size : 1);
    }
  }
  return sizes;
}

Cell newCell(const Case& which, const ChartMethod& method) {
  Cell cell;
  cell.section = which.section;
  cell.workload = which.name;
  cell.x = which.x;
  cell.method = method.name();
  cell.family = method.family;
  cell.size = method.size;
  cell.threads = method.threads;
  cell.queries = static_cast<uint32_t>(which.workload.queries.size());
  return cell;
}

bench::Repetition repetitionOf(Extent extent) {
  if (extent == Extent::full) return {.least = 5, .most = kNone, .seconds = 0.2};
  if (extent == Extent::quick) return {.least = 3, .most = kNone, .seconds = 0.03};
  return {.least = 1, .most = 1};
}

}  // namespace

void judge(Cell& cell, std::span<const Result> results, std::span<const Result> truth, std::span<const double> sizes) {
  std::vector<double> errors, widths;
  for (size_t i = 0; i < results.size(); ++i) {
    const Verdict verdict = judge(results[i], truth[i], sizes[i]);
    const bool isBounded = !std::isnan(results[i].hi);
    cell.contacts += meets(truth[i]);
    cell.found += verdict.found;
    cell.misses += verdict[Fault::missed] || verdict.unseen;
    cell.falseHits += verdict[Fault::falseHit];
    cell.violations += verdict[Fault::bracket] || (verdict[Fault::falseHit] && isBounded) ||
                       (verdict[Fault::missed] && cell.certified);
    if (!verdict.found) continue;
    errors.push_back(finite(verdict.error));
    if (cell.certified) widths.push_back(finite((results[i].hi - results[i].lo) / sizes[i]));
  }
  cell.errorMedian = quantile(errors, 0.5);
  cell.error99 = quantile(errors, 0.99);
  cell.errorWorst = quantile(errors, 1);
  cell.widthWorst = quantile(widths, 1);
}

Record measureAll(const RunSettings& settings, Record record, const Device& device, const std::filesystem::path& folder,
                  const std::function<void()>& step) {
  std::optional<Record> before = readRecord(folder);
  if (before && before->values("run") == record.values("run")) record.cells = std::move(before->cells);
  // A method that takes several times as long makes fewer passes than it should, but one.
  const bench::Repetition repetition = repetitionOf(settings.extent);
  size_t done = 0;
  for (const Case& which : settings.cases) {
    std::vector<Result> truth;
    std::vector<double> sizes;
    for (const ChartMethod& method : methodsOf(which.section, settings)) {
      step();
      if (done++ < record.cells.size()) continue;
      if (truth.empty()) {
        Cell exact = newCell(which, {});
        truth = searchOnCpu(exact, which.workload, {.warmUps = 0, .least = 1, .most = 1});
        sizes = sizesOf(which.workload);
      }
      Cell& cell = record.cells.emplace_back(newCell(which, method));
      const std::vector<Result> results =
          method.row != nullptr          ? castInChild(cell, which.workload, *method.row, repetition)
          : method.family == "reference" ? searchOnCpu(cell, which.workload, repetition)
                                         : searchOnDevice(cell, which.workload, repetition, device);
      if (cell.failed.empty()) judge(cell, results, truth, sizes);
      writeRecord(folder, record);
    }
  }
  return record;
}

}  // namespace radar::tools
