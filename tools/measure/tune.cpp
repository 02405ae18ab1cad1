#include "measure/tune.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "contact/submitter.h"
#include "contact/tuning.h"
#include "measure/timing.h"
#include "scene/scene.h"
#include "workloads/generate.h"
#include "workloads/interlocking.h"

namespace radar::tools {

namespace {

// One number of a tuning, and the values to try; where the usual one depends on the batch, factors of it.
struct Knob {
  const char* name;
  uint32_t SearchTuning::*number;
  std::vector<double> values;
  uint32_t (*usual)(const SearchTuning&, const Device::Impl&, uint32_t searches) = nullptr;
};

std::vector<Knob> knobsOf(const Device::Impl& device) {
  const double lanes = device.subgroupSize;
  return {{"objectSteps", &SearchTuning::objectSteps, {2, 4, 8, 16, 32}},
          {"nodeSteps", &SearchTuning::nodeSteps, {4, 8, 16, 24, 48}},
          {"few", &SearchTuning::few, {lanes / 4, lanes / 2, 3 * lanes / 4}},
          {"queue", &SearchTuning::queue, {6 * lanes, 8 * lanes, 16 * lanes}},
          {"leafBatch", &SearchTuning::leafBatch, {lanes, 2 * lanes, 4 * lanes}},
          {"stack", &SearchTuning::stack, {24, 40, 64}},
          {"split", &SearchTuning::split, {16, 48, 144}},
          {"rounds", &SearchTuning::rounds, {2, 4, 8, 16}},
          {"groups x", &SearchTuning::groups, {0.5, 2, 4}, groupsFor},
          {"width x", &SearchTuning::width, {0.25, 0.5, 2}, widthFor}};
}

/// A batch in a scene on the device, and its answers.
class Bench {
 public:
  Bench(const Device& device, std::string name, const Workload& workload)
      : name_(std::move(name)),
        workload_(workload),
        player_(workload_),
        device_(device.impl()),
        copy_(device_),
        usual_(device_, copy_, true, {}) {
    player_.show(0);
    queries_.assign(workload_.queries.begin(), workload_.queries.end());
    static constexpr std::array kAll{kNone};
    const Scene::Impl& scene = player_.scene().impl();
    for (size_t i = 0; i < queries_.size(); ++i) list_.add(queries_, i, {queries_[i], scene}, kAll);
  }

  const std::string& name() const { return name_; }
  uint32_t count() const { return list_.count(); }

  /// The device's time over that of the usual numbers, in turns. Throws Error if answers are not those of the first
  /// call.
  double measure(const SearchTuning& tuning, uint32_t repeats) {
    ContactSubmitter tuned(device_, copy_, true, tuning);
    std::vector<double> times, usual;
    // The first compiles, and makes room.
    for (uint32_t i = 0; i <= repeats; ++i) {
      const double before = msOf(usual_), ms = msOf(tuned);
      if (i == 0) continue;
      usual.push_back(before);
      times.push_back(ms);
    }
    return median(times) / median(usual);
  }

 private:
  double msOf(ContactSubmitter& submitter) {
    const Scene::Impl& scene = player_.scene().impl();
    std::vector<StageTime> stages;
    submitter.submit(list_.source({queries_, &scene}), scene);
    compare(submitter.collect(stages, {}).results);
    double sum = 0;
    for (const StageTime& stage : stages) sum += stage.ms;
    return sum;
  }

  // What is open, or had no room, may differ.
  void compare(std::span<const Result> results) {
    if (answers_.empty()) answers_.assign(results.begin(), results.end());
    for (size_t i = 0; i < results.size(); ++i) {
      if (results[i].flags != 0 || answers_[i].flags != 0) continue;
      if (std::memcmp(&results[i], &answers_[i], sizeof(Result)) == 0) continue;
      throw Error(Error::Kind::internal, name_ + ", query " + std::to_string(i) + ": the answer depends on the tuning");
    }
  }

  std::string name_;
  Workload workload_;
  ScenePlayer player_;
  const Device::Impl& device_;
  GpuScene copy_;
  ContactSubmitter usual_;
  std::vector<Query> queries_;
  SearchList list_;
  std::vector<Result> answers_;
};

std::vector<std::unique_ptr<Bench>> benchesOf(const Device& device, double share) {
  const auto few = [&](double queries) { return static_cast<uint32_t>(std::max(1.0, std::round(share * queries))); };
  std::vector<std::unique_ptr<Bench>> benches;
  const auto add = [&](const char* name, const Workload& workload) {
    benches.push_back(std::make_unique<Bench>(device, name, workload));
  };
  add("boxes", makeWorkload(Table1{.boxes = 30'000, .sensors = few(16'384), .shape = SensorShape::box}));
  add("teapots", makeWorkload(Table1{.boxes = 10'000, .sensors = few(16'384), .shape = SensorShape::teapot}));
  add("many boxes", makeWorkload(Table1{.boxes = few(1'000'000), .sensors = few(16'384), .shape = SensorShape::box}));
  add("pegs", makeWorkload(InterlockingPairs{.kind = Interlocking::ringOnPeg, .sensors = few(1'024)}));
  add("few teapots", makeWorkload(Table1{.boxes = 10'000, .sensors = few(64), .shape = SensorShape::teapot}));
  return benches;
}

}  // namespace

size_t tuneSteps(const Device& device) {
  size_t steps = 2;
  for (const Knob& knob : knobsOf(device.impl())) steps += knob.values.size();
  return steps;
}

void tune(const Device& device, const TuneSettings& settings, Json& report, const std::function<void()>& advance) {
  const std::vector<std::unique_ptr<Bench>> benches = benchesOf(device, settings.share);
  Json rows = Json::array();
  // `tuningOf`: of a number of searches. Returns the geometric mean of the times over the usual ones.
  const auto addRow = [&](const std::string& name, const auto& value, const auto& tuningOf) {
    Json row{{"number", name}, {"value", value}};
    double logarithms = 0;
    for (const std::unique_ptr<Bench>& bench : benches) {
      const double ratio = bench->measure(tuningOf(bench->count()), settings.repeats);
      row[bench->name()] = ratio;
      logarithms += std::log(ratio);
    }
    const double mean = std::exp(logarithms / static_cast<double>(benches.size()));
    row["mean"] = mean;
    rows.push_back(row);
    setRows(report, "tune", "The device's time with one number changed, over the usual one's", rows);
    advance();
    return mean;
  };
  const auto with = [&](SearchTuning tuning, const Knob& knob, double value, uint32_t searches) {
    const SearchTuning whole = tunedFor(device.impl(), {});
    const double number = knob.usual == nullptr ? value : value * knob.usual(whole, device.impl(), searches);
    tuning.*knob.number = static_cast<uint32_t>(std::max(1.0, std::round(number)));
    return tuning;
  };
  // How much the machine's other work matters.
  addRow("usual", "", [](uint32_t) { return SearchTuning(); });
  std::vector<std::pair<Knob, double>> better;
  for (const Knob& knob : knobsOf(device.impl())) {
    double least = 0.98, best = 0;
    for (const double value : knob.values) {
      const double mean = addRow(knob.name, value, [&](uint32_t searches) { return with({}, knob, value, searches); });
      if (mean < least) std::tie(least, best) = std::pair(mean, value);
    }
    if (best != 0) better.emplace_back(knob, best);
  }
  std::string names;
  for (const auto& [knob, value] : better) {
    names += (names.empty() ? "" : ", ") + std::string(knob.name) + " " + print("%g", value);
  }
  addRow("together", names, [&](uint32_t searches) {
    SearchTuning tuning;
    for (const auto& [knob, value] : better) tuning = with(tuning, knob, value, searches);
    return tuning;
  });
}

}  // namespace radar::tools
