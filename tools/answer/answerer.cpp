#include "answer/answerer.h"

#include <utility>

namespace radar::tools {

void Answerer::edit(const std::function<void()>& change) {
  if (pool_) {
    pool_->edit(change);
  } else {
    change();
  }
}

void Answerer::open(AnswerMode mode) {
  if (mode == AnswerMode::reference) {
    if (!cpu_) cpu_.emplace(scene_, options_.threads);
    return;
  }
  if (sweeper_ || pool_) return;
  const SweeperOptions options{
      .timestamps = options_.timestamps, .cpuBatch = options_.cpuBatch, .cpuThreads = options_.threads};
  const DeviceOptions device{.index = options_.device,
                             .onValidation = options_.onValidation,
                             .debugNames = false,
                             .onCompiling = options_.onCompiling};
  if (options_.pool) {
    devices_ = openDevices(*options_.pool, device);
    pool_.emplace(devices_, scene_, options);
  } else {
    devices_.clear();
    devices_.push_back(Device::open(device));
    sweeper_.emplace(devices_[0], scene_, options);
  }
}

void Answerer::sync() {
  if (sweeper_) sweeper_->sync();
  if (cpu_) cpu_->sync();
}

Answers Answerer::run(const std::vector<Query>& queries, AnswerMode mode, const std::stop_token& stop) {
  Answers answers;
  run(queries, answers, mode, stop);
  return answers;
}

void Answerer::run(const std::vector<Query>& queries, Answers& answers, AnswerMode mode, const std::stop_token& stop) {
  open(mode);
  if (mode == AnswerMode::reference) return cpu_->run(queries, answers, stop);
  const Mode ofDevice = mode == AnswerMode::sampled ? Mode::sampled : Mode::contact;
  if (pool_) {
    answers = pool_->submit(queries, ofDevice, stop).get();
  } else {
    sweeper_->run(queries, answers, ofDevice, stop);
  }
  if (options_.onLost && !answers.stats.lost.empty()) std::exchange(options_.onLost, nullptr)(answers.stats.lost);
}

}  // namespace radar::tools
