#include "scale/measure.h"

#include <algorithm>
#include <cstring>
#include <memory>
#include <optional>

#include "measure/timing.h"

namespace radar::tools {

namespace {

// The devices' places: the first 1, 2, ... of them, then the second, third, ... alone.
std::vector<std::vector<uint32_t>> setsOf(size_t devices) {
  std::vector<std::vector<uint32_t>> sets;
  std::vector<uint32_t> first;
  for (uint32_t i = 0; i < devices; ++i) {
    first.push_back(i);
    sets.push_back(first);
  }
  for (uint32_t i = 1; i < devices; ++i) sets.push_back({i});
  return sets;
}

struct Timed {
  Lap lap;
  std::vector<Result> results;
  std::vector<PoolAnswers> batches;  // without results
};

// The pools of all sets over one scene, which shows one workload after the other.
class Pools {
 public:
  Pools(std::span<const Device> devices, const Workload& first, const ScaleSettings& settings) : settings_(settings) {
    player_.emplace(first);
    for (const std::vector<uint32_t>& set : setsOf(devices.size())) {
      for (const bool timestamps : {false, true}) {
        const SweeperOptions options{.select = settings.select, .timestamps = timestamps, .cpuBatch = 0};
        (timestamps ? profiled_ : pools_)
            .push_back(std::make_unique<Pool>(devices.subspan(set.front(), set.size()), player_->scene(), options));
      }
    }
  }

  // No batch is with any pool.
  void load(const Workload& workload) {
    player_.emplace(workload);  // the same place: the pools' scene
    batches_ = batchesOf(workload.queries, settings_.resolution);
  }

  Timed run(size_t set, bool profile) {
    Pool& pool = *(profile ? profiled_ : pools_)[set];
    Timed pass;
    const auto answer = [&](std::span<const Query> queries) {
      PoolAnswers& answers =
          pass.batches.emplace_back(pool.submit({queries.begin(), queries.end()}, settings_.mode).get());
      if (!answers.reasons.empty()) throw Error("a query was not answered: " + answers.reasons.begin()->second);
      if (!answers.retired.empty()) throw Error("a device was given up: " + answers.retired.front());
      return std::move(answers.results);
    };
    const auto show = [&](uint32_t scene) { pool.edit([&] { player_->show(scene); }); };
    Pass played = play({"", answer, show}, batches_);
    (pass.lap = played.show) += played.answer;
    pass.results = std::move(played.answers);
    return pass;
  }

  size_t batches() const { return batches_.size(); }

 private:
  const ScaleSettings& settings_;
  std::optional<ScenePlayer> player_;
  std::vector<std::unique_ptr<Pool>> pools_, profiled_;
  std::vector<Batch> batches_;
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

void summarize(ScaleRun& run, std::vector<Timed> passes) {
  Lap all;
  for (const Timed& pass : passes) all += pass.lap;
  run.cores = all.process / all.wall;
  std::sort(passes.begin(), passes.end(), [](const Timed& a, const Timed& b) { return a.lap.wall < b.lap.wall; });
  run.least = 1e3 * passes.front().lap.wall;
  run.most = 1e3 * passes.back().lap.wall;
  Timed& median = passes[passes.size() / 2];
  run.ms = run.scene = 1e3 * median.lap.wall;
  run.shares.resize(run.devices.size());
  for (const PoolAnswers& batch : median.batches) {
    run.scene -= batch.answered - batch.submitted;
    for (uint32_t i = 0; i < run.shares.size(); ++i) addShare(run.shares[i], batch, i);
  }
  run.batches = std::move(median.batches);
}

bool sameBits(const std::vector<Result>& a, const std::vector<Result>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Result)) == 0;
}

void addStages(std::vector<StageTime>& stages, const Timed& pass) {
  for (const PoolAnswers& batch : pass.batches) {
    for (const StageTime& stage : batch.stats.stages) {
      const auto found =
          std::find_if(stages.begin(), stages.end(), [&](const StageTime& other) { return other.name == stage.name; });
      (found == stages.end() ? stages.emplace_back(StageTime{stage.name, 0}) : *found).ms += stage.ms;
    }
  }
}

}  // namespace

const ScaleRun& ScaleReport::run(size_t point, size_t deviceCount) const {
  return runs[point * (2 * numbers.size() - 1) + deviceCount - 1];
}

const ScaleRun& ScaleReport::alone(size_t point, uint32_t device) const {
  return device == 0 ? run(point, 1) : runs[point * (2 * numbers.size() - 1) + numbers.size() + device - 1];
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

ScaleReport measureScale(std::span<const Device> devices, const std::vector<uint32_t>& numbers,
                         const std::vector<ScalePoint>& points, const ScaleSettings& settings,
                         const std::function<void()>& step) {
  ScaleReport report;
  report.numbers = numbers;
  const auto sets = setsOf(devices.size());
  Pools pools(devices, points.front().workload, settings);
  for (size_t p = 0; p < points.size(); ++p) {
    pools.load(points[p].workload);
    report.sensors.push_back(points[p].sensors);
    report.batches.push_back(pools.batches());
    report.queries.push_back(points[p].workload.queries.size());
    std::vector<std::vector<Timed>> passes(sets.size());
    std::vector<Result> expected;
    inTurns({.least = settings.repeats, .most = settings.repeats}, sets.size(), [&](size_t s, bool counts) {
      step();
      Timed pass = pools.run(s, false);
      if (expected.empty()) expected = pass.results;
      report.sameBits = report.sameBits && sameBits(pass.results, expected);
      pass.results = {};
      if (counts) passes[s].push_back(std::move(pass));
    });
    for (size_t s = 0; s < sets.size(); ++s) {
      ScaleRun& run = report.runs.emplace_back();
      run.devices = sets[s];
      run.point = p;
      summarize(run, std::move(passes[s]));
      if (p + 1 < points.size()) continue;
      inTurns({.least = 1, .most = 1}, 1, [&](size_t, bool counts) {
        step();
        const Timed profiled = pools.run(s, true);
        if (counts) addStages(run.stages, profiled);
      });
    }
  }
  return report;
}

}  // namespace radar::tools
