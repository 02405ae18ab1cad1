#include "chart/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "chart/in_child.h"
#include "radar/cpu_sweeper.h"
#include "workloads/workload.h"

namespace radar::tools {

namespace {

// Of processor time, for a peer to prepare itself and answer: a hull of many triangles takes minutes.
constexpr unsigned kMostSeconds = 25;

using Clock = std::chrono::steady_clock;

// A slow method gets so many budgets, then fewer passes than it should.
constexpr double kPatience = 6;

double msSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Of all threads of this process.
double processorMs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& time) { return 1e3 * double(time.tv_sec) + 1e-3 * double(time.tv_usec); };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// A method at work on a workload.
struct Runner {
  std::function<void(uint32_t scene)> show;        ///< a scene, until it could answer
  std::function<void(const Batch& batch)> answer;  ///< keeps its answers
};

void timePasses(Cell& cell, const Workload& workload, const Timing& timing, const Runner& runner) {
  const std::vector<Batch> batches = batchesOf(workload);
  const auto pass = [&](double& answerMs, double& sceneMs, double& cpuMs) {
    for (const Batch& batch : batches) {
      const Clock::time_point start = Clock::now();
      runner.show(batch.scene);
      sceneMs += msSince(start);
      const double cpu = processorMs();
      const Clock::time_point asked = Clock::now();
      runner.answer(batch);
      answerMs += msSince(asked);
      cpuMs += processorMs() - cpu;
    }
  };
  double unused = 0;
  pass(unused, unused, unused);
  const double perQuery = 1e3 / static_cast<double>(workload.queries.size());
  std::vector<double> times;
  double sceneMs = 0, cpuMs = 0;
  const Clock::time_point start = Clock::now();
  const auto isEnough = [&] {
    const double ms = msSince(start);
    return ms >= kPatience * timing.budgetMs || (ms >= timing.budgetMs && times.size() >= timing.least);
  };
  do {
    double ms = 0;
    pass(ms, sceneMs, cpuMs);
    times.push_back(ms * perQuery);
  } while (!isEnough());
  cell.passes = static_cast<uint32_t>(times.size());
  cell.us = quantile(times, 0.5);
  cell.usLow = quantile(times, 0.25);
  cell.usHigh = quantile(times, 0.75);
  cell.cpuUs = cpuMs * perQuery / cell.passes;
  cell.sceneUs = sceneMs * perQuery / cell.passes;
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

// The whole question, whatever the file says of modes.
Query asked(const QuerySpec& spec, Mode mode, uint32_t resolution) {
  Query query = toQuery(spec, mode, resolution);
  query.anyHit = false;
  return query;
}

std::vector<Query> queriesOf(const Workload& workload, const Batch& batch, Mode mode, uint32_t resolution) {
  std::vector<Query> queries;
  for (const uint32_t i : batch.queries) queries.push_back(asked(workload.queries[i], mode, resolution));
  return queries;
}

std::vector<Instance> objectsOf(const Workload& workload, uint32_t scene) {
  const SceneSpec& spec = workload.scenes[scene];
  std::vector<Instance> objects;
  if (spec.base) objects = workload.scenes[*spec.base].instances;
  objects.insert(objects.end(), spec.instances.begin(), spec.instances.end());
  return objects;
}

// The queries, with what their masks leave out named as excluded.
std::vector<QuerySpec> unmasked(const Workload& workload) {
  std::vector<QuerySpec> queries = workload.queries;
  for (QuerySpec& query : queries) {
    for (const auto& [object, bits] : workload.scenes[query.scene].masks) {
      if ((bits & query.mask) == 0) query.exclude.push_back(object);
    }
  }
  return queries;
}

// The numbers that a child hands over, in one order for both ways.
void eachTime(Cell& cell, const std::function<void(double&)>& visit) {
  for (double* value : {&cell.prepareMs, &cell.us, &cell.usLow, &cell.usHigh, &cell.cpuUs, &cell.sceneUs}) {
    visit(*value);
  }
}

std::vector<double> castAll(const Case& which, const Method& method, const BaselineRow& row, const Timing& timing) {
  const Workload& workload = which.workload;
  const std::vector<QuerySpec> queries = unmasked(workload);
  Cell cell;
  const Clock::time_point start = Clock::now();
  std::vector<std::unique_ptr<Baseline>> peers;
  peers.push_back(row.make(workload, method.size));
  peers[0]->show(objectsOf(workload, 0));
  cell.prepareMs = msSince(start);
  while (peers.size() < method.threads) peers.push_back(row.make(workload, method.size));
  std::vector<double> told(queries.size(), NAN);
  std::optional<uint32_t> shown;
  timePasses(cell, workload, timing,
             {[&](uint32_t scene) {
                if (shown == scene) return;
                const std::vector<Instance> objects = objectsOf(workload, scene);
                for (const std::unique_ptr<Baseline>& peer : peers) peer->show(objects);
                shown = scene;
              },
              [&](const Batch& batch) {
                inThreads(method.threads, batch.queries.size(), [&](uint32_t thread, size_t i) {
                  const uint32_t query = batch.queries[i];
                  told[query] = peers[thread]->cast(queries[query]).value_or(NAN);
                });
              }});
  std::vector<double> values{static_cast<double>(cell.passes)};
  eachTime(cell, [&](double& value) { values.push_back(value); });
  values.insert(values.end(), told.begin(), told.end());
  return values;
}

}  // namespace

Truth truthOf(const Workload& workload) {
  ScenePlayer player(workload);
  CpuSweeper exact(player.scene());
  Truth truth;
  truth.results.resize(workload.queries.size());
  truth.sizes.resize(workload.queries.size());
  for (const Batch& batch : batchesOf(workload)) {
    player.show(batch.scene);
    const std::vector<Query> queries = queriesOf(workload, batch, Mode::contact, 0);
    const std::vector<Result> results = exact.run(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
      truth.results[batch.queries[i]] = results[i];
      const double size = sensorSize(player.scene(), queries[i]);
      truth.sizes[batch.queries[i]] = size > 0 ? size : 1;
    }
  }
  return truth;
}

struct Bench::Engine {
  Engine(const Workload& workload, const Device& device, const SweeperOptions& given)
      : options(given), player(workload), sweeper(device, shown(), given) {
    sweeper.sync();
    prepareMs = msSince(start);
  }
  const Scene& shown() {
    player.show(0);
    return player.scene();
  }

  Clock::time_point start = Clock::now();
  double prepareMs = 0;
  SweeperOptions options;
  ScenePlayer player;
  Sweeper sweeper;
};

Bench::Bench(const Case& which, const Device& device, const Timing& timing)
    : which_(which), device_(device), timing_(timing), truth_(truthOf(which.workload)) {}

Bench::~Bench() = default;

Cell Bench::measure(const Method& method, const BaselineRow* row) {
  if (row != nullptr) return measureBaseline(method, *row);
  return method.family == "reference" ? measureReference(method) : measureEngine(method);
}

Cell Bench::cellOf(const Method& method) const {
  Cell cell;
  cell.section = which_.section;
  cell.workload = which_.name;
  cell.x = which_.x;
  cell.method = method.name();
  cell.family = method.family;
  cell.size = method.size;
  cell.threads = method.threads;
  cell.queries = static_cast<uint32_t>(which_.workload.queries.size());
  return cell;
}

Cell Bench::measureEngine(const Method& method) {
  const Workload& workload = which_.workload;
  const Mode mode = method.family.starts_with("contact") ? Mode::contact : Mode::sampled;
  Cell cell = cellOf(method);
  cell.certified = mode != Mode::sampled;
  const SweeperOptions options{.select = method.family != "drawing all",
                               .cpuBatch = method.family == "contact on device" ? 0 : kNone};
  if (!engine_ || engine_->options.select != options.select || engine_->options.cpuBatch != options.cpuBatch) {
    engine_ = std::make_unique<Engine>(workload, device_, options);
  }
  cell.prepareMs = engine_->prepareMs;
  ScenePlayer& player = engine_->player;
  Sweeper& sweeper = engine_->sweeper;
  std::vector<Result> results(workload.queries.size());
  timePasses(cell, workload, timing_,
             {[&](uint32_t scene) {
                player.show(scene);
                sweeper.sync();
              },
              [&](const Batch& batch) {
                const std::vector<Result> part = sweeper.run(queriesOf(workload, batch, mode, method.size));
                for (size_t i = 0; i < part.size(); ++i) results[batch.queries[i]] = part[i];
              }});
  std::vector<Told> told;
  for (const Result& result : results) told.push_back(toldBy(result));
  judge(cell, told, truth_.results, truth_.sizes);
  countTiers(cell, results);
  return cell;
}

Cell Bench::measureReference(const Method& method) {
  const Workload& workload = which_.workload;
  Cell cell = cellOf(method);
  cell.certified = true;
  const Clock::time_point start = Clock::now();
  ScenePlayer player(workload);
  player.show(0);
  CpuSweeper exact(player.scene(), method.threads);
  exact.sync();
  cell.prepareMs = msSince(start);
  std::vector<Result> results(workload.queries.size());
  timePasses(cell, workload, timing_,
             {[&](uint32_t scene) {
                player.show(scene);
                exact.sync();
              },
              [&](const Batch& batch) {
                const std::vector<Result> part = exact.run(queriesOf(workload, batch, Mode::contact, 0));
                for (size_t i = 0; i < part.size(); ++i) results[batch.queries[i]] = part[i];
              }});
  std::vector<Told> told;
  for (const Result& result : results) told.push_back(toldBy(result));
  judge(cell, told, truth_.results, truth_.sizes);
  countTiers(cell, results);
  return cell;
}

Cell Bench::measureBaseline(const Method& method, const BaselineRow& row) {
  Cell cell = cellOf(method);
  const ChildOutcome outcome = inChild([&] { return castAll(which_, method, row, timing_); }, kMostSeconds);
  cell.failed = outcome.failed;
  if (!cell.failed.empty()) return cell;
  size_t next = 0;
  cell.passes = static_cast<uint32_t>(outcome.values[next++]);
  eachTime(cell, [&](double& value) { value = outcome.values[next++]; });
  std::vector<Told> told;
  for (; next < outcome.values.size(); ++next) {
    const double t = outcome.values[next];
    told.push_back({std::isnan(t) ? Told::Kind::none : Told::Kind::contact, t, NAN, NAN});
  }
  judge(cell, told, truth_.results, truth_.sizes);
  return cell;
}

}  // namespace radar::tools
