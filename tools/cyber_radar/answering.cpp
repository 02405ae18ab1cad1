#include "cyber_radar/answering.h"

#include <algorithm>
#include <chrono>

namespace radar::tools {

namespace {

using Clock = std::chrono::steady_clock;

double millisecondsSince(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

void addStage(std::vector<StageTime>& stages, const StageTime& stage) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.name == stage.name; });
  if (found == stages.end()) {
    stages.push_back(stage);
  } else {
    found->ms += stage.ms;
  }
}

}  // namespace

Answering::Answering(const Workload& workload, const AnsweringOptions& options)
    : workload_(workload), player_(workload) {
  bool needsDevice = false, needsReference = false;
  for (const Batch& batch : batchesOf(workload)) {
    Group& group = groups_.emplace_back();
    group.scene = batch.scene;
    for (uint32_t number : batch.queries) {
      const QuerySpec& spec = workload.queries[number];
      const bool sampled = spec.mode.value_or(options.mode) == Mode::sampled;
      (sampled ? needsDevice : needsReference) = true;
      Part& part = sampled ? group.sampled : group.reference;
      part.numbers.push_back(number);
      part.queries.push_back(toQuery(spec, options.resolution));
    }
  }
  if (needsDevice) {
    device_ = Device::open({.index = options.device});
    sweeper_.emplace(*device_, player_.scene(), SweeperOptions{.timestamps = options.timestamps});
  }
  if (needsReference) reference_ = std::make_unique<reference::Reference>(player_.scene());
}

double Answering::setUp() {
  const auto start = Clock::now();
  if (!groups_.empty()) player_.show(groups_.front().scene);
  if (sweeper_) sweeper_->sync();
  if (reference_) reference_->sync();
  return millisecondsSince(start);
}

Answering::Pass Answering::run(const std::string& label) {
  Pass pass;
  pass.answers.resize(workload_.queries.size());
  Progress progress(label, workload_.queries.size());
  const uint64_t pairsBefore = reference_ ? reference_->pairs() : 0;
  const auto start = Clock::now();
  for (const Group& group : groups_) {
    player_.show(group.scene);
    sample(group.sampled, pass, progress);
    refer(group.reference, pass, progress);
  }
  pass.ms = millisecondsSince(start);
  if (reference_) {
    pass.pairs += reference_->pairs() - pairsBefore;
    pass.cpuPairs += reference_->pairs() - pairsBefore;
  }
  return pass;
}

void Answering::sample(const Part& part, Pass& pass, Progress& progress) {
  if (part.queries.empty()) return;
  const std::vector<Result> results = sweeper_->run(part.queries);
  for (size_t i = 0; i < results.size(); ++i) {
    pass.answers[part.numbers[i]] = {results[i], Mode::sampled, sweeper_->reason(i)};
  }
  const SweepStats& stats = sweeper_->stats();
  pass.pairs += stats.pairs;
  pass.cpuPairs += stats.cpuPairs;
  for (const StageTime& stage : stats.stages) addStage(pass.stages, stage);
  progress.add(results.size());
}

void Answering::refer(const Part& part, Pass& pass, Progress& progress) {
  if (part.queries.empty()) return;
  const auto start = Clock::now();
  for (size_t i = 0; i < part.queries.size(); ++i) {
    pass.answers[part.numbers[i]] = {reference_->answer(part.queries[i]), Mode::reference, {}};
    progress.add(1);
  }
  addStage(pass.stages, {"reference", millisecondsSince(start)});
}

}  // namespace radar::tools
