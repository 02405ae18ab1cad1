#include "measure/scale.h"

#include <algorithm>
#include <cstring>
#include <map>
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

std::string setOf(const ScaleReport& report, const ScaleRun& run) {
  std::string text;
  for (const uint32_t device : run.devices) text += (text.empty() ? "" : "+") + std::to_string(report.numbers[device]);
  return text;
}

Json runRow(const ScaleReport& measured, const ScaleRun& run) {
  const double all = run.ms * static_cast<double>(run.devices.size()), first = measured.alone(run.point, 0).ms;
  DeviceShare sum;
  double useful = 0, speeds = 0;
  for (size_t i = 0; i < run.shares.size(); ++i) {
    const DeviceShare& share = run.shares[i];
    const ScaleRun& alone = measured.alone(run.point, run.devices[i]);
    const DeviceShare& own = alone.shares[0];
    speeds += 1 / alone.ms;
    useful += own.queries > 0 ? own.busy / own.queries * share.queries : 0;
    sum.busy += share.busy;
    sum.start += share.start;
    sum.gap += share.gap;
    sum.tail += share.tail;
    sum.encode += share.encode;
  }
  return {{"sensors", measured.sensors[run.point]},
          {"devices", setOf(measured, run)},
          {"ms_per_batch", run.ms / static_cast<double>(measured.batches[run.point])},
          {"speed_up", first / run.ms},
          {"efficiency", 1 / (speeds * run.ms)},
          {"useful_%", 100 * useful / all},
          {"slower_%", 100 * (sum.busy - useful) / all},
          {"start_%", 100 * sum.start / all},
          {"gap_%", 100 * sum.gap / all},
          {"tail_%", 100 * sum.tail / all},
          {"scene_%", 100 * run.scene / run.ms},
          {"encode_%", sum.busy > 0 ? 100 * sum.encode / sum.busy : 0},
          {"cores", run.cores}};
}

Json shareRow(const ScaleReport& measured, const ScaleRun& run, size_t device) {
  const DeviceShare& share = run.shares[device];
  return {{"sensors", measured.sensors[run.point]},
          {"devices", setOf(measured, run)},
          {"device", measured.numbers[run.devices[device]]},
          {"batches", measured.batches[run.point]},
          {"queries", measured.queries[run.point]},
          {"ms", run.ms},
          {"ms_least", run.least},
          {"ms_most", run.most},
          {"device_queries", share.queries},
          {"chunks", share.chunks},
          {"chunk_least", share.leastChunk},
          {"chunk_most", share.mostChunk},
          {"busy_ms", share.busy},
          {"idle_start_ms", share.start},
          {"idle_gap_ms", share.gap},
          {"idle_tail_ms", share.tail},
          {"encode_ms", share.encode},
          {"wait_ms", share.wait},
          {"decode_ms", share.decode}};
}

}  // namespace

// The first device is a set of one; those alone follow the sets.
const ScaleRun& ScaleReport::alone(size_t point, uint32_t device) const {
  return runs[point * (2 * numbers.size() - 1) + (device == 0 ? 0 : numbers.size() + device - 1)];
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

void addTables(const ScaleReport& measured, Json& report) {
  Json runs = Json::array(), shares = Json::array(), stages = Json::array();
  for (const ScaleRun& run : measured.runs) {
    runs.push_back(runRow(measured, run));
    for (size_t i = 0; i < run.shares.size(); ++i) shares.push_back(shareRow(measured, run, i));
    for (const StageTime& stage : run.stages) {
      stages.push_back({{"devices", setOf(measured, run)}, {"stage", stage.name}, {"ms", stage.ms}});
    }
  }
  setRows(report, "runs", "What is gained, and where the devices' time goes", runs);
  setRows(report, "scale", "Each device", shares);
  setRows(report, "stages", "Stages of the most sensors", stages);
}

Json scaleLines(const Json& runs) {
  Json lines = Json::array();
  std::map<std::string, size_t> linetypes;
  for (const Json& row : runs) {
    const std::string devices = row["devices"];
    const size_t linetype = linetypes.emplace(devices, 2 * linetypes.size() + 1).first->second;
    lines.push_back({{"name", devices},
                     {"linetype", linetype},
                     {"x", row["sensors"]},
                     {"ms_per_batch", row["ms_per_batch"]},
                     {"speed_up", row["speed_up"]},
                     {"efficiency", 100 * row["efficiency"].get<double>()}});
  }
  return lines;
}

std::string traceOf(const ScaleReport& report) {
  Json events = Json::array();
  const auto name = [&](const char* what, size_t process, size_t thread, const std::string& text) {
    events.push_back({{"name", what}, {"ph", "M"}, {"pid", process}, {"tid", thread}, {"args", {{"name", text}}}});
  };
  const auto span = [&](const std::string& text, size_t process, size_t thread, double from, double to, Json args) {
    if (to <= from) return;
    events.push_back({{"name", text},
                      {"ph", "X"},
                      {"pid", process},
                      {"tid", thread},
                      {"ts", 1e3 * from},
                      {"dur", 1e3 * (to - from)},
                      {"args", std::move(args)}});
  };
  for (size_t r = 0; r < report.runs.size(); ++r) {
    const ScaleRun& run = report.runs[r];
    if (run.point + 1 < report.sensors.size()) continue;
    name("process_name", r, 0, "devices " + setOf(report, run));
    name("thread_name", r, 0, "batches");
    const double origin = run.batches.front().submitted;
    for (size_t i = 0; i < run.devices.size(); ++i) {
      const std::string number = std::to_string(report.numbers[run.devices[i]]);
      name("thread_name", r, 2 * i + 1, "device " + number);
      name("thread_name", r, 2 * i + 2, "thread of device " + number);
    }
    std::vector<double> free(run.devices.size(), 0);
    for (size_t b = 0; b < run.batches.size(); ++b) {
      const PoolAnswers& batch = run.batches[b];
      span("batch " + std::to_string(b), r, 0, batch.submitted - origin, batch.answered - origin, Json::object());
      for (const ChunkTrace& chunk : batch.chunks) {
        const size_t thread = 2 * chunk.device + 2;
        const Json args{{"queries", chunk.queries}};
        // A device does one after the other: what is submitted meanwhile waits in its queue.
        double& since = free[chunk.device];
        span("chunk of " + std::to_string(chunk.queries), r, thread - 1, std::max(chunk.submitted - origin, since),
             chunk.done - origin, args);
        since = std::max(since, chunk.done - origin);
        span("encode and submit", r, thread, chunk.begun - origin, chunk.submitted - origin, args);
        span("wait", r, thread, chunk.awaited - origin, chunk.done - origin, args);
        span("decode", r, thread, std::max(chunk.done, chunk.awaited) - origin, chunk.decoded - origin, args);
      }
    }
  }
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", std::move(events)}}.dump() + "\n";
}

}  // namespace radar::tools
