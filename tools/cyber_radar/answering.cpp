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

// Modes of the engine, and of answers found by it.
constexpr std::pair<AnswerMode, Mode> kSwept[] = {
    {AnswerMode::sampled, Mode::sampled}, {AnswerMode::bounded, Mode::bounded}, {AnswerMode::contact, Mode::contact}};

Mode engineModeOf(AnswerMode mode) {
  return std::find_if(std::begin(kSwept), std::end(kSwept), [&](const auto& m) { return m.first == mode; })->second;
}

AnswerMode answerModeOf(Mode mode) {
  return std::find_if(std::begin(kSwept), std::end(kSwept), [&](const auto& m) { return m.second == mode; })->first;
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
      const AnswerMode mode = spec.mode.value_or(options.mode);
      const bool swept = mode != AnswerMode::reference;
      (swept ? needsDevice : needsReference) = true;
      Part& part = swept ? group.swept : group.referred;
      part.numbers.push_back(number);
      part.queries.push_back(toQuery(spec, swept ? engineModeOf(mode) : Mode::contact, options.resolution));
      part.queries.back().tolerance = spec.tolerance.value_or(options.tolerance);
    }
  }
  const SweeperOptions sweeperOptions{.timestamps = options.timestamps};
  if (needsDevice && options.pool) {
    devices_ = openDevices(*options.pool);
    pool_.emplace(devices_, player_.scene(), sweeperOptions);
  } else if (needsDevice) {
    devices_.push_back(Device::open({.index = options.device}));
    sweeper_.emplace(devices_[0], player_.scene(), sweeperOptions);
  }
  if (needsReference) reference_ = std::make_unique<reference::Reference>(player_.scene());
}

void Answering::show(uint32_t scene) {
  if (pool_) {
    pool_->edit([&] { player_.show(scene); });
  } else {
    player_.show(scene);
  }
}

double Answering::setUp() {
  const auto start = Clock::now();
  if (!groups_.empty()) show(groups_.front().scene);
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
    show(group.scene);
    sweep(group.swept, pass, progress);
    refer(group.referred, pass, progress);
  }
  pass.ms = millisecondsSince(start);
  if (reference_) {
    pass.pairs += reference_->pairs() - pairsBefore;
    pass.cpuPairs += reference_->pairs() - pairsBefore;
  }
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
    const AnswerMode mode = part.queries[i].mode == Mode::sampled ? AnswerMode::sampled : AnswerMode::contact;
    const auto reason = answers.reasons.find(i);
    pass.answers[part.numbers[i]] = {answers.results[i], mode, reason == answers.reasons.end() ? "" : reason->second};
  }
  pass.pairs += answers.stats.pairs;
  pass.cpuPairs += answers.stats.cpuPairs;
  for (const StageTime& stage : answers.stats.stages) addStage(pass.stages, stage);
  progress.add(answers.results.size());
}

void Answering::refer(const Part& part, Pass& pass, Progress& progress) {
  if (part.queries.empty()) return;
  const auto start = Clock::now();
  for (size_t i = 0; i < part.queries.size(); ++i) {
    pass.answers[part.numbers[i]] = {reference_->answer(part.queries[i]), AnswerMode::reference, {}};
    progress.add(1);
  }
  addStage(pass.stages, {"reference", millisecondsSince(start)});
}

}  // namespace radar::tools
