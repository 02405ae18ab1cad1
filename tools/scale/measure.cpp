#include "scale/measure.h"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <fstream>
#include <memory>
#include <optional>
#include <thread>

namespace radar::tools {

namespace {

using Clock = std::chrono::steady_clock;

double processorMs() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) { return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * t.tv_usec; };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

// Of all processor cores, in one unit: in use, and altogether. Zero where the system does not say.
struct MachineTime {
  double used = 0, all = 0;
};

MachineTime machineTime() {
  MachineTime time;
  std::ifstream stat("/proc/stat");
  std::string name;
  stat >> name;
  double value = 0;
  for (int i = 0; i < 8 && stat >> value; ++i) {
    time.all += value;
    if (i != 3 && i != 4) time.used += value;  // idle, waiting for a disk
  }
  return time;
}

// The devices' places, and whether a set is a device measured for itself.
std::vector<std::pair<std::vector<uint32_t>, bool>> setsOf(size_t devices) {
  std::vector<std::pair<std::vector<uint32_t>, bool>> sets;
  std::vector<uint32_t> first;
  for (uint32_t i = 0; i < devices; ++i) {
    first.push_back(i);
    sets.emplace_back(first, false);
  }
  for (uint32_t i = 1; i < devices; ++i) sets.emplace_back(std::vector<uint32_t>{i}, true);
  return sets;
}

struct PlayedBatch {
  uint32_t scene = 0;
  std::vector<Query> queries;
};

std::vector<PlayedBatch> played(const Workload& workload, const ScaleSettings& settings) {
  std::vector<PlayedBatch> batches;
  for (const Batch& batch : batchesOf(workload)) {
    PlayedBatch& one = batches.emplace_back();
    one.scene = batch.scene;
    for (const uint32_t i : batch.queries) {
      one.queries.push_back(toQuery(workload.queries[i], settings.mode, settings.resolution));
    }
  }
  return batches;
}

struct Pass {
  double ms = 0, processor = 0;
  MachineTime machine;
  std::vector<PoolAnswers> batches;
};

/// The pools of all sets over one scene, which shows one workload after the other.
class Bench {
 public:
  Bench(std::span<const Device> devices, const Workload& first, const ScaleSettings& settings) : settings_(settings) {
    player_.emplace(first);
    for (const auto& [set, alone] : setsOf(devices.size())) pools_.push_back(poolOf(devices, set, false));
    for (const auto& [set, alone] : setsOf(devices.size())) profiled_.push_back(poolOf(devices, set, true));
  }

  /// No batch is with any pool.
  void load(const Workload& workload) {
    player_.emplace(workload);  // the same place: the pools' scene
    batches_ = played(workload, settings_);
  }

  Pass run(size_t set, bool profile) {
    Pool& pool = *(profile ? profiled_ : pools_)[set];
    Pass pass;
    const double processor = processorMs();
    const MachineTime machine = machineTime();
    const Clock::time_point start = Clock::now();
    for (const PlayedBatch& batch : batches_) {
      pool.edit([&] { player_->show(batch.scene); });
      pass.batches.push_back(pool.submit(batch.queries).get());
    }
    pass.ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
    pass.processor = processorMs() - processor;
    const MachineTime after = machineTime();
    pass.machine = {after.used - machine.used, after.all - machine.all};
    for (const PoolAnswers& answers : pass.batches) {
      if (!answers.reasons.empty()) throw Error("a query was not answered: " + answers.reasons.begin()->second);
      if (!answers.retired.empty()) throw Error("a device was given up: " + answers.retired.front());
    }
    return pass;
  }

  size_t batches() const { return batches_.size(); }

 private:
  std::unique_ptr<Pool> poolOf(std::span<const Device> devices, const std::vector<uint32_t>& set, bool timestamps) {
    return std::make_unique<Pool>(devices.subspan(set.front(), set.size()), player_->scene(),
                                  SweeperOptions{.select = settings_.select, .timestamps = timestamps, .cpuBatch = 0});
  }

  const ScaleSettings& settings_;
  std::optional<ScenePlayer> player_;
  std::vector<std::unique_ptr<Pool>> pools_, profiled_;
  std::vector<PlayedBatch> batches_;
};

// The chunks of one device in one batch, by the time of their submission.
void addShare(DeviceShare& share, const PoolAnswers& batch, uint32_t device) {
  std::vector<const ChunkTrace*> chunks;
  for (const ChunkTrace& chunk : batch.chunks) {
    if (chunk.device == device) chunks.push_back(&chunk);
  }
  std::sort(chunks.begin(), chunks.end(), [](const auto* a, const auto* b) { return a->submitted < b->submitted; });
  double idleSince = batch.submitted;
  for (size_t i = 0; i < chunks.size(); ++i) {
    const ChunkTrace& chunk = *chunks[i];
    share.leastChunk = share.chunks == 0 ? chunk.queries : std::min(share.leastChunk, chunk.queries);
    share.mostChunk = std::max(share.mostChunk, chunk.queries);
    ++share.chunks;
    share.queries += chunk.queries;
    (i == 0 ? share.start : share.gap) += std::max(0.0, chunk.submitted - idleSince);
    share.busy += std::max(0.0, chunk.done - std::max(chunk.submitted, idleSince));
    share.encode += chunk.submitted - chunk.begun;
    share.wait += std::max(0.0, chunk.done - chunk.awaited);
    share.decode += chunk.decoded - std::max(chunk.done, chunk.awaited);
    idleSince = std::max(idleSince, chunk.done);
  }
  share.tail += std::max(0.0, batch.answered - idleSince);
}

void summarize(ScaleRun& run, std::vector<Pass> passes) {
  double processor = 0, all = 0;
  MachineTime machine;
  for (const Pass& pass : passes) {
    processor += pass.processor;
    all += pass.ms;
    machine.used += pass.machine.used;
    machine.all += pass.machine.all;
  }
  run.cores = processor / all;
  run.machine = machine.all > 0 ? machine.used / machine.all : 0;
  std::sort(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) { return a.ms < b.ms; });
  run.least = passes.front().ms;
  run.most = passes.back().ms;
  Pass& median = passes[passes.size() / 2];
  run.ms = run.scene = median.ms;
  run.shares.resize(run.devices.size());
  for (const PoolAnswers& batch : median.batches) {
    run.scene -= batch.answered - batch.submitted;
    for (uint32_t i = 0; i < run.shares.size(); ++i) addShare(run.shares[i], batch, i);
  }
  run.batches = std::move(median.batches);
}

bool sameBits(const std::vector<PoolAnswers>& a, const std::vector<std::vector<Result>>& b) {
  for (size_t i = 0; i < a.size(); ++i) {
    if (a[i].results.size() != b[i].size() ||
        std::memcmp(a[i].results.data(), b[i].data(), b[i].size() * sizeof(Result)) != 0) {
      return false;
    }
  }
  return a.size() == b.size();
}

std::string nameOf(const std::vector<uint32_t>& set, double sensors) {
  std::string text = std::to_string(static_cast<long>(sensors + 0.5)) + " sensors on device";
  for (const uint32_t device : set) text += " " + std::to_string(device);
  return text;
}

}  // namespace

const ScaleRun& ScaleReport::run(size_t point, size_t deviceCount) const {
  return runs[point * (2 * devices.size() - 1) + deviceCount - 1];
}

const ScaleRun& ScaleReport::alone(size_t point, uint32_t device) const {
  return device == 0 ? run(point, 1) : runs[point * (2 * devices.size() - 1) + devices.size() + device - 1];
}

double ScaleReport::speedUp(const ScaleRun& of) const {
  return run(of.point, 1).ms / of.ms;
}

double ScaleReport::efficiency(const ScaleRun& of) const {
  double speeds = 0;
  for (const uint32_t device : of.devices) speeds += 1 / alone(of.point, device).ms;
  return 1 / (speeds * of.ms);
}

size_t scaleSteps(size_t devices, size_t points, const ScaleSettings& settings) {
  return setsOf(devices).size() * (points * (settings.repeats + 1) + 2);
}

ScaleReport measureScale(std::span<const Device> devices, const std::vector<ScalePoint>& points,
                         const ScaleSettings& settings, const std::function<void(const std::string&)>& step) {
  ScaleReport report;
  report.processors = std::thread::hardware_concurrency();
  for (const Device& device : devices) report.devices.push_back({.name = device.name(), .driver = device.driver()});
  const auto sets = setsOf(devices.size());
  Bench bench(devices, points.front().workload, settings);
  for (size_t p = 0; p < points.size(); ++p) {
    bench.load(points[p].workload);
    report.sensors.push_back(points[p].sensors);
    report.batches.push_back(bench.batches());
    report.queries.push_back(points[p].workload.queries.size());
    std::vector<std::vector<Pass>> passes(sets.size());
    std::vector<std::vector<Result>> expected;
    // In turns, so that what else the machine does meets all sets alike. The first turn warms up.
    for (uint32_t turn = 0; turn <= settings.repeats; ++turn) {
      for (size_t s = 0; s < sets.size(); ++s) {
        step(nameOf(sets[s].first, points[p].sensors));
        Pass pass = bench.run(s, false);
        if (expected.empty()) {
          for (const PoolAnswers& batch : pass.batches) expected.push_back(batch.results);
        }
        report.sameBits = report.sameBits && sameBits(pass.batches, expected);
        for (PoolAnswers& batch : pass.batches) batch.results = {};
        if (turn > 0) passes[s].push_back(std::move(pass));
      }
    }
    for (size_t s = 0; s < sets.size(); ++s) {
      ScaleRun& run = report.runs.emplace_back();
      run.devices = sets[s].first;
      run.alone = sets[s].second;
      run.point = p;
      summarize(run, std::move(passes[s]));
      if (p + 1 < points.size()) continue;
      for (const bool warm : {false, true}) {
        step(nameOf(sets[s].first, points[p].sensors) + ", stages");
        const Pass profiled = bench.run(s, true);
        if (!warm) continue;
        for (const PoolAnswers& batch : profiled.batches) {
          for (const StageTime& stage : batch.stats.stages) {
            const auto found = std::find_if(run.stages.begin(), run.stages.end(),
                                            [&](const StageTime& other) { return other.name == stage.name; });
            (found == run.stages.end() ? run.stages.emplace_back(StageTime{stage.name, 0}) : *found).ms += stage.ms;
          }
        }
      }
    }
  }
  return report;
}

}  // namespace radar::tools
