#include "contact/submitter.h"

#include <algorithm>
#include <chrono>

#include "gpu/barrier.h"

namespace radar {

namespace {

// A batch whose searches take more submissions than this makes no progress.
constexpr uint32_t kMostSubmissions = 1u << 20;

// Such a device is given up.
const char* wordsFor(uint32_t broken) {
  switch (broken) {
    case gpu::kBrokenSubgroups:
      return "the device runs a workgroup of the contact search as several subgroups";
    case gpu::kBrokenLoops:
      return "the driver ends loops of the contact search early";
    default:
      return "the device lets lanes go apart where the contact search needs all";
  }
}

uint64_t joined(uint32_t low, uint32_t high) {
  return uint64_t{high} << 32 | low;
}

}  // namespace

void Pace::took(double ms) {
  if (!isHurried_) return;
  if (ms > kWantedMs) {
    budget_ = std::max(static_cast<uint32_t>(budget_ * (kWantedMs / ms)), kLeast);
  } else if (ms < kWantedMs / 2) {
    budget_ = std::min(2 * budget_, most_);
  }
}

void Rounds::took(uint32_t rounds) {
  if (learns_) count_ = rounds > count_ ? most_ : std::max((rounds + 1) / 2 * 2, count_ - 2);
}

namespace {

gpu::Buffer readbackFor(const gpu::Owner& owner) {
  return {owner, "contact readback", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT};
}

}  // namespace

ContactSubmitter::ContactSubmitter(const gpu::Owner& owner, GpuScene& scene, bool timestamps,
                                   const SearchTuning& tuning)
    : scene_(scene),
      now_(tuning.now ? tuning.now : std::chrono::steady_clock::now),
      pace_(tuning.budget == 0 && (tuning.now || !owner.device().runsOnCpu()),
            tuning.budget != 0 ? tuning.budget : kMostBudget),
      rounds_(tunedFor(owner, tuning).rounds, tuning.rounds == 0),
      submission_(owner, timestamps),
      pass_(owner, scene, tuning),
      readbacks_{readbackFor(owner), readbackFor(owner)} {}

const gpu::SearchCounts& ContactSubmitter::counts() const {
  return *reinterpret_cast<const gpu::SearchCounts*>(readbacks_[readback_].mapped());
}

void ContactSubmitter::recordAndSubmit() {
  pass_.setBudget(pace_.budget());
  const gpu::Commands commands = submission_.begin();
  gpu::computeToOverwrite(commands);  // a recording that shares the scene's copy may still be searching it
  const auto stage = [this](const char* name) { submission_.stage(name); };
  pass_.recordUpload(commands, stage);
  if (submissions_ == 0) pass_.recordEncoding(commands, stage);
  pass_.record(commands, stage, rounds_.count(), false);
  gpu::computeWriteToCopy(commands);
  stage("readback");
  const VkBufferCopy counts{0, 0, sizeof(gpu::SearchCounts)};
  const VkBufferCopy results{0, PairSolver::kFirstResult, pass_.searchCount() * sizeof(Result)};
  commands->CmdCopyBuffer(commands, pass_.counts().get(), readbacks_[readback_].get(), 1, &counts);
  commands->CmdCopyBuffer(commands, pass_.results().get(), readbacks_[readback_].get(), 1, &results);
  gpu::writtenToHost(commands);
  submission_.submit();
  ++submissions_;
}

void ContactSubmitter::submit(const SearchSource& batch, const Scene::Impl& scene) {
  submissions_ = 0;
  staged_ = pass_.stage(batch, {}, scene);
  readback_ = 1 - readback_;
  readbacks_[readback_].reserve(PairSolver::kFirstResult + batch.count * sizeof(Result));
  recordAndSubmit();
}

void ContactSubmitter::wait() {
  submission_.wait();
  scene_.commit(std::move(staged_));
}

SearchAnswers ContactSubmitter::collect(std::vector<StageTime>& stages, const std::stop_token& stop) {
  wait();
  submission_.addTimes(stages);
  uint32_t rounds = 0;
  while (rounds <= rounds_.count() && counts().rounds[rounds].tasks != 0) ++rounds;
  rounds_.took(rounds);
  while (counts().broken == 0 && pass_.tasksLeft(counts()) != 0) {
    if (submissions_ == kMostSubmissions) throw Error(Error::Kind::internal, "the contact search makes no progress");
    throwIfStopped(stop);
    pass_.stageMore(counts());
    const auto begun = now_();
    recordAndSubmit();
    submission_.wait();
    pace_.took(std::chrono::duration<double, std::milli>(now_() - begun).count());
    submission_.addTimes(stages);
  }
  const gpu::SearchCounts& all = counts();
  if (all.broken != 0) throw Error(wordsFor(all.broken), VK_ERROR_DEVICE_LOST);
  auto* results = reinterpret_cast<Result*>(readbacks_[readback_].mapped() + PairSolver::kFirstResult);
  const std::span<const gpu::UnresolvedPair> unresolved = pass_.unresolved(all);
  return {{results, pass_.searchCount()},
          {unresolved.begin(), unresolved.end()},
          pass_.learn(all),
          joined(all.trianglePairs, all.trianglePairsHigh)};
}

}  // namespace radar
