#include "cyber_radar/answering.h"

#include <algorithm>

#include "batch/query_file.h"
#include "bench/clock.h"
#include "cyber_radar/commands.h"

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

Answering::Answering(const Workload& workload, const AnsweringOptions& options)
    : workload_(workload), player_(workload) {
  bool needsDevice = false, needsCpu = false;
  for (const Batch& batch : batchesOf(workload)) {
    Group& group = groups_.emplace_back();
    group.scene = batch.scene;
    for (uint32_t number : batch.queries) {
      const QuerySpec& spec = workload.queries[number];
      const AnswerMode mode = spec.mode.value_or(options.mode);
      if (mode == AnswerMode::sampled && needsExactMode(workload, spec)) {
        throw InputError("--mode", "",
                         std::string("expected ") + kExactModes + " (query \"" + spec.id + "\"), got sampled");
      }
      const bool swept = mode != AnswerMode::reference;
      (swept ? needsDevice : needsCpu) = true;
      Part& part = swept ? group.swept : group.onCpu;
      part.numbers.push_back(number);
      part.modes.push_back(mode);
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
  const auto keep = [&](const Part& part, const PoolAnswers& found) {
    for (size_t i = 0; i < found.results.size(); ++i) {
      const auto reason = found.reasons.find(i);
      const auto hits = found.lists.hitsOf(i);
      const auto overlapping = found.lists.overlappingOf(i);
      pass.answers[part.numbers[i]] = {found.results[i],
                                       part.modes[i],
                                       reason == found.reasons.end() ? "" : reason->second,
                                       {hits.begin(), hits.end()},
                                       {overlapping.begin(), overlapping.end()}};
    }
    pass.pairs += found.stats.pairs;
    pass.cpuPairs += found.stats.cpuPairs;
    for (const StageTime& stage : found.stats.stages) addStage(pass.stages, stage);
    progress.add(found.results.size());
  };
  for (const Group& group : groups_) {
    show(group.scene);
    if (!group.swept.queries.empty()) keep(group.swept, sweep(group.swept.queries));
    if (!group.onCpu.queries.empty()) keep(group.onCpu, answerOnCpu(group.onCpu.queries));
  }
  pass.ms = 1e3 * (bench::now() - start);
  return pass;
}

PoolAnswers Answering::sweep(const std::vector<Query>& queries) {
  if (pool_) return pool_->submit(queries).get();
  PoolAnswers found;
  found.results = sweeper_->run(queries);
  found.lists = sweeper_->lists();
  for (size_t i = 0; i < queries.size(); ++i) {
    if (found.results[i].status == Status::invalid) found.reasons[i] = sweeper_->reason(i);
  }
  found.stats = sweeper_->stats();
  return found;
}

PoolAnswers Answering::answerOnCpu(const std::vector<Query>& queries) {
  const double start = bench::now();
  PoolAnswers found;
  found.results = cpu_->run(queries);
  found.lists = cpu_->lists();
  found.stats.pairs = found.stats.cpuPairs = cpu_->stats().pairs;
  found.stats.stages = {{"reference", 1e3 * (bench::now() - start)}};
  return found;
}

std::string answerLines(const Workload& workload, const std::vector<Answer>& answers) {
  std::vector<std::vector<std::string>> names;
  for (uint32_t scene = 0; scene < workload.scenes.size(); ++scene) names.push_back(workload.objectNames(scene));
  std::string lines;
  for (size_t i = 0; i < answers.size(); ++i) {
    const QuerySpec& query = workload.queries[i];
    lines += answerLine(query, answers[i], names[query.scene]) + "\n";
  }
  return lines;
}

int exitStatusOf(const std::vector<Answer>& answers) {
  const bool someInvalid =
      std::any_of(answers.begin(), answers.end(), [](const Answer& a) { return a.result.status == Status::invalid; });
  return someInvalid ? kStatusSomeInvalid : 0;
}

}  // namespace radar::tools
