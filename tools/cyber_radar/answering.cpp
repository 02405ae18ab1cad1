#include "cyber_radar/answering.h"

#include <algorithm>

#include "bench/clock.h"

namespace radar::tools {

namespace {

void addStage(std::vector<StageTime>& stages, const StageTime& stage) {
  const auto found = std::find_if(stages.begin(), stages.end(), [&](const auto& s) { return s.name == stage.name; });
  if (found == stages.end()) {
    stages.push_back(stage);
  } else {
    found->ms += stage.ms;
  }
}

// Of answers found by the engine.
AnswerMode answerModeOf(Mode mode) {
  return mode == Mode::sampled ? AnswerMode::sampled : AnswerMode::contact;
}

}  // namespace

Answering::Answering(const Workload& workload, const AnsweringOptions& options)
    : workload_(workload), player_(workload) {
  bool needsDevice = false, needsCpu = false;
  for (const Batch& batch : batchesOf(workload)) {
    Group& group = groups_.emplace_back();
    group.scene = batch.scene;
    for (uint32_t number : batch.queries) {
      const QuerySpec& spec = workload.queries[number];
      const AnswerMode mode = spec.mode.value_or(options.mode);
      const bool swept = mode != AnswerMode::reference;
      (swept ? needsDevice : needsCpu) = true;
      Part& part = swept ? group.swept : group.onCpu;
      part.numbers.push_back(number);
      part.queries.push_back(
          toQuery(spec, mode == AnswerMode::sampled ? Mode::sampled : Mode::contact, options.resolution));
    }
  }
  const SweeperOptions sweeperOptions{
      .timestamps = options.timestamps, .cpuBatch = options.cpuBatch, .cpuThreads = options.threads};
  if (needsDevice && options.pool) {
    devices_ = openDevices(*options.pool);
    pool_.emplace(devices_, player_.scene(), sweeperOptions);
  } else if (needsDevice) {
    devices_.push_back(Device::open({.index = options.device}));
    sweeper_.emplace(devices_[0], player_.scene(), sweeperOptions);
  }
  if (needsCpu) cpu_.emplace(player_.scene(), options.threads);
}

void Answering::show(uint32_t scene) {
  if (pool_) {
    pool_->edit([&] { player_.show(scene); });
  } else {
    player_.show(scene);
  }
}

double Answering::setUp() {
  const double start = bench::now();
  if (!groups_.empty()) show(groups_.front().scene);
  if (sweeper_) sweeper_->sync();
  if (cpu_) cpu_->sync();
  return 1e3 * (bench::now() - start);
}

Answering::Pass Answering::run(const std::string& label) {
  Pass pass;
  pass.answers.resize(workload_.queries.size());
  Progress progress(label, workload_.queries.size());
  const double start = bench::now();
  for (const Group& group : groups_) {
    show(group.scene);
    sweep(group.swept, pass, progress);
    answerOnCpu(group.onCpu, pass, progress);
  }
  pass.ms = 1e3 * (bench::now() - start);
  return pass;
}

void Answering::sweep(const Part& part, Pass& pass, Progress& progress) {
  if (part.queries.empty()) return;
  if (pool_) {
    share(part, pass, progress);
    return;
  }
  const std::vector<Result> results = sweeper_->run(part.queries);
  for (size_t i = 0; i < results.size(); ++i) {
    pass.answers[part.numbers[i]] = {results[i], answerModeOf(part.queries[i].mode), sweeper_->reason(i)};
  }
  const SweepStats& stats = sweeper_->stats();
  pass.pairs += stats.pairs;
  pass.cpuPairs += stats.cpuPairs;
  for (const StageTime& stage : stats.stages) addStage(pass.stages, stage);
  progress.add(results.size());
}

void Answering::share(const Part& part, Pass& pass, Progress& progress) {
  const PoolAnswers answers = pool_->submit(part.queries).get();
  for (size_t i = 0; i < answers.results.size(); ++i) {
    const AnswerMode mode = answerModeOf(part.queries[i].mode);
    const auto reason = answers.reasons.find(i);
    pass.answers[part.numbers[i]] = {answers.results[i], mode, reason == answers.reasons.end() ? "" : reason->second};
  }
  pass.pairs += answers.stats.pairs;
  pass.cpuPairs += answers.stats.cpuPairs;
  for (const StageTime& stage : answers.stats.stages) addStage(pass.stages, stage);
  progress.add(answers.results.size());
}

void Answering::answerOnCpu(const Part& part, Pass& pass, Progress& progress) {
  if (part.queries.empty()) return;
  const double start = bench::now();
  const std::vector<Result> results = cpu_->run(part.queries);
  for (size_t i = 0; i < results.size(); ++i) pass.answers[part.numbers[i]] = {results[i], AnswerMode::reference, {}};
  pass.pairs += cpu_->stats().pairs;
  pass.cpuPairs += cpu_->stats().pairs;
  progress.add(results.size());
  addStage(pass.stages, {"reference", 1e3 * (bench::now() - start)});
}

}  // namespace radar::tools
