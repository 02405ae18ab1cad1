#include "cyber_radar/answering.h"

#include <algorithm>

#include "measure/clock.h"

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

}  // namespace

Answering::Answering(const Workload& world, const ModesAsked& asked, const AnsweringOptions& options)
    : options_(options), player_(world) {
  if (options.mode == AnswerMode::sampled && !asked.exactOnly.empty()) {
    throw InputError("--mode", "", "expected contact or reference, as " + asked.exactOnly + " needs, got sampled");
  }
  const bool needsDevice =
      asked.asks(AnswerMode::sampled, options.mode) || asked.asks(AnswerMode::contact, options.mode);
  const SweeperOptions sweeperOptions{
      .timestamps = options.timestamps, .cpuBatch = options.cpuBatch, .cpuThreads = options.threads};
  if (needsDevice && options.pool) {
    devices_ = openDevices(*options.pool);
    pool_.emplace(devices_, player_.scene(), sweeperOptions);
  } else if (needsDevice) {
    devices_.push_back(Device::open({.index = options.device}));
    sweeper_.emplace(devices_[0], player_.scene(), sweeperOptions);
  }
  if (asked.asks(AnswerMode::reference, options.mode)) cpu_.emplace(player_.scene(), options.threads);
}

void Answering::show(uint32_t scene) {
  if (pool_) {
    pool_->edit([&] { player_.show(scene); });
  } else {
    player_.show(scene);
  }
}

double Answering::setUp(uint32_t scene) {
  const double start = now();
  show(scene);
  if (sweeper_) sweeper_->sync();
  if (cpu_) cpu_->sync();
  return 1e3 * (now() - start);
}

std::vector<Answering::Group> Answering::groupsOf(std::span<const QuerySpec> queries) const {
  std::vector<Group> groups;
  for (Batch& batch : batchesOf(queries, options_.resolution)) {
    Group& group = groups.emplace_back();
    group.scene = batch.scene;
    for (size_t i = 0; i < batch.numbers.size(); ++i) {
      const AnswerMode mode = queries[batch.numbers[i]].mode.value_or(options_.mode);
      Part& part = group.parts[static_cast<size_t>(mode)];
      part.numbers.push_back(batch.numbers[i]);
      part.queries.push_back(std::move(batch.queries[i]));
    }
  }
  return groups;
}

std::vector<Answer> Answering::run(std::span<const QuerySpec> queries, Progress& progress) {
  std::vector<Answer> answers(queries.size());
  const std::vector<Group> groups = groupsOf(queries);
  const double start = now();
  const auto keep = [&](const Part& part, AnswerMode mode, Answers found) {
    for (size_t i = 0; i < found.results.size(); ++i) {
      answers[part.numbers[i]] = {.result = found.results[i], .mode = mode};
    }
    for (size_t i = 0; i < found.lists.size(); ++i) answers[part.numbers[i]].listed = std::move(found.lists[i]);
    for (const auto& [i, reason] : found.reasons) answers[part.numbers[i]].reason = reason;
    for (const Result& result : found.results) {
      ++stats_.statuses[static_cast<size_t>(result.status)];
      if (result.resolution == 0) continue;
      stats_.leastResolution = std::min(stats_.leastResolution, result.resolution);
      stats_.mostResolution = std::max(stats_.mostResolution, result.resolution);
    }
    stats_.pairs += found.stats.pairs;
    stats_.cpuPairs += found.stats.cpuPairs;
    for (const StageTime& stage : found.stats.stages) addStage(stats_.stages, stage);
    progress.add(found.results.size());
  };
  for (const Group& group : groups) {
    show(group.scene);
    for (const AnswerMode mode : {AnswerMode::sampled, AnswerMode::contact, AnswerMode::reference}) {
      const Part& part = group.parts[static_cast<size_t>(mode)];
      if (!part.queries.empty()) keep(part, mode, answer(part.queries, mode));
    }
  }
  stats_.batches += groups.size();
  stats_.ms += 1e3 * (now() - start);
  return answers;
}

Answers Answering::answer(const std::vector<Query>& queries, AnswerMode mode) {
  if (mode == AnswerMode::reference) {
    const double start = now();
    Answers found = cpu_->run(queries);
    found.stats.stages = {{"reference", 1e3 * (now() - start)}};
    return found;
  }
  const Mode ofDevice = mode == AnswerMode::sampled ? Mode::sampled : Mode::contact;
  if (pool_) return pool_->submit(queries, ofDevice).get();
  return sweeper_->run(queries, ofDevice);
}

std::vector<Answer> answersTo(const Workload& workload, Answering& answering, const std::string& label) {
  Progress progress(label, workload.queries.size());
  if (!workload.queries.empty()) answering.setUp(workload.queries[0].scene);
  return answering.run(workload.queries, progress);
}

bool someInvalid(std::span<const Answer> answers) {
  return std::ranges::any_of(answers, [](const Answer& a) { return a.result.status == Status::invalid; });
}

}  // namespace radar::tools
