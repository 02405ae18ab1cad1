#include "embed/recorder.h"

#include <limits>

#include "embed/capacity.h"
#include "gpu/barrier.h"
#include "math/float_environment.h"
#include "query/route.h"
#include "scene/scene_copy.h"
#include "sweep/proof.h"

namespace radar {

namespace {

// Excluded objects per query for which memory is reserved in advance.
constexpr uint32_t kExcluded = 2;
SearchTuning tuningFor(const Capacity& capacity, const Device::Impl& device) {
  return {.candidates = capacity.candidates,
          .unresolved = capacity.unresolvedPairs,
          .budget = device.runsOnCpu() ? kMostBudget : kBriefBudget};
}

}  // namespace

Recorder::Impl::Impl(const Device::Impl& openDevice, const Scene& ownScene, std::shared_ptr<GpuScene> ownCopy,
                     const Capacity& given)
    : device(openDevice),
      owner(gpu::Owner::counted(openDevice)),
      scene(ownScene),
      capacity(completed(given, openDevice)),
      copy(std::move(ownCopy)),
      geometry(owner, *copy),
      pass(owner, *copy, tuningFor(capacity, openDevice)),
      gathers(owner, capacity.searches),
      readback(owner, "recorded results", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  const uint32_t results = capacity.queries + 2 * capacity.searches;  // lists are no longer than what they are from
  pass.reserve(capacity.queries + capacity.searches, results, kExcluded * capacity.queries);
  makeReadback(kFirstResult + results * sizeof(Result));
}

void Recorder::Impl::validateAll(std::span<const Query> queries) const {
  if (queries.size() > capacity.queries) {
    throw Error("expected at most " + std::to_string(capacity.queries) + " queries, got " +
                std::to_string(queries.size()));
  }
  requireValid(queries, scene, Mode::contact, true);
}

void Recorder::Impl::validateHost(const HostQueries& queries, const HostGeometry& hostGeometry) const {
  if (std::string wrong = validate(queries, capacity.queries); !wrong.empty()) throw Error("queries: " + wrong);
  if (scene.impl().moving > 0) throw Error("queries: expected a scene in which no object has a motion");
  if (std::string wrong = validate(hostGeometry, scene); !wrong.empty()) throw Error("geometry: " + wrong);
}

Recorder::Recorder(const Device& device, const Scene& scene, const Capacity& capacity) {
  const FloatEnvironment floats;
  requireRecorderProof(device.impl());
  impl_ = std::make_unique<Impl>(device.impl(), scene, std::make_shared<GpuScene>(device.impl()), capacity);
}
Recorder::Recorder(SceneCopy& copy, const Capacity& capacity) {
  const FloatEnvironment floats;
  requireRecorderProof(copy.impl_->device);
  impl_ = std::make_unique<Impl>(copy.impl_->device, copy.impl_->scene, copy.impl_->copy, capacity);
  impl_->isShared = true;
}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

// Records what either kind of record() has staged.
void Recorder::Impl::recordSearch(VkCommandBuffer commandBuffer, GpuScene::Staged staged) {
  const bool areWritten = recorded.isWritten;
  const uint32_t results = areWritten ? recorded.count : static_cast<uint32_t>(recorded.known.size());
  const gpu::Commands commands{&device.vk, commandBuffer};
  const char* open = nullptr;
  const auto stage = [&](const char* name) {
    if (open != nullptr) device.endLabel(commands);
    device.beginLabel(commands, name);
    open = name;
  };
  if (isShared) gpu::computeToOverwrite(commands);
  if (!gathers.empty()) gathers.recordUpload(commands);
  pass.recordUpload(commands, stage);
  if (!geometry.empty()) {
    stage("geometry");
    geometry.record(commands, scene.impl(), pass.searchCount());
  }
  if (areWritten && results != 0) {
    stage("plan");
    hostQueries->record(commands, pass, *copy, scene.impl());
  }
  pass.recordEncoding(commands, stage);
  pass.record(commands, stage, capacity.rounds, true);
  if (!gathers.empty()) {
    stage("gather");
    gathers.record(commands, pass.results(), recorded.hitOffsets.back());
  }
  if (!geometry.empty()) geometry.recordInvalidate(commands, pass.results(), results);
  gpu::computeWriteToCopy(commands);
  stage("readback");
  const auto readBack = [&](const gpu::Buffer& from, VkDeviceSize to, VkDeviceSize bytes) {
    const VkBufferCopy region{0, to, bytes};
    if (bytes != 0) commands->CmdCopyBuffer(commands, from.get(), readback.get(), 1, &region);
  };
  geometry.recordReadback(commands);
  readBack(pass.counts(), 0, sizeof(gpu::SearchCounts));
  readBack(pass.results(), kFirstResult, results * sizeof(Result));
  if (areWritten) readBack(pass.stated().sweeps, firstSweep(), results * sizeof(gpu::Sweep));
  gpu::writtenToHost(commands);
  device.endLabel(commands);
  copy->commit(std::move(staged));
  geometry.confirm();
  usedBuffers = copy->shareBuffers();
  recorded.farthest = copy->farthest();
  recorded.isComplete = true;
  serial = pass.serial();
}

void Recorder::Impl::begin(const HostGeometry& hostGeometry) {
  recorded.isComplete = false;  // if recording fails, read() has nothing to return
  usedBuffers.reset();
  geometry.stage(hostGeometry, scene.impl());
}

GpuScene::Staged Recorder::Impl::stage(std::span<const Query> queries, const HostGeometry& hostGeometry) {
  validateAll(queries);
  if (std::string wrong = validate(hostGeometry, scene); !wrong.empty()) throw Error("geometry: " + wrong);
  begin(hostGeometry);
  recorded.plan(queries, scene.impl(), geometry, capacity.searches);
  gathers.stage(recorded.gathered);
  return pass.stage(recorded.searches.source(), recorded.known, scene.impl(), geometry.overwritten());
}

GpuScene::Staged Recorder::Impl::stage(const HostQueries& queries, const HostGeometry& hostGeometry) {
  validateHost(queries, hostGeometry);
  begin(hostGeometry);
  recorded.planWritten(queries.count);
  gathers.stage(recorded.gathered);
  GpuScene::Staged staged = pass.stageWritten(queries.count, scene.impl(), geometry.overwritten());
  makeReadback(firstSweep() + capacity.queries * sizeof(gpu::Sweep));
  if (!hostQueries) hostQueries.emplace(owner);
  if (queries.count != 0) hostQueries->stage(queries);
  return staged;
}

void Recorder::record(VkCommandBuffer commands, std::span<const Query> queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  impl_->record(commands, queries, geometry);
}

void Recorder::record(VkCommandBuffer commands, const HostQueries& queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  impl_->record(commands, queries, geometry);
}

void Recorder::Impl::upload() {
  if (device.host.queue == VK_NULL_HANDLE) return;
  copy->sync(scene.impl());
  copy->dropStaging();
}

void Recorder::prepare(std::span<const Query> queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  impl_->upload();
  impl_->stageFor("prepare", queries, geometry);
}

void Recorder::prepare(const HostQueries& queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  impl_->upload();
  impl_->stageFor("prepare", queries, geometry);
}

void Recorder::reset() {
  impl_->recorded.isComplete = false;
  impl_->copy->forget();
  impl_->geometry.forget();
}

VkBuffer Recorder::results() const {
  return impl_->pass.results().get();
}

std::span<const uint32_t> Recorder::hitOffsets() const {
  return impl_->recorded.hitOffsets;
}

Answers Recorder::read() {
  const FloatEnvironment floats;
  return impl_->read();
}

Answers Recorder::Impl::read() {
  if (!recorded.isComplete) return {};
  requireExecuted("read");
  recorded.learn(geometry.unboundedBoxes());
  const std::byte* const mapped = readback.mapped();
  const size_t count = recorded.isWritten ? recordedResults().size() : recorded.known.size();
  const auto* first = reinterpret_cast<const Result*>(mapped + kFirstResult);
  std::vector<Result> results(first, first + count);
  const auto pairs = pass.unresolved(counts());
  if (!recorded.isWritten) return recorded.answers(std::move(results), pairs);
  const auto* sweeps = reinterpret_cast<const gpu::Sweep*>(mapped + firstSweep());
  return recorded.answersToWritten(std::move(results), pairs, sweeps);
}

Capacity Recorder::needed() const {
  const Impl& self = *impl_;
  Capacity needed = self.capacity;
  if (!self.recorded.isComplete || self.isPending() || self.recorded.count == 0) return needed;
  const gpu::SearchCounts& counts = self.counts();
  const auto of = [](uint32_t count, uint32_t capacity) {
    constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max();
    return count <= capacity ? std::max(count, 1u) : static_cast<uint32_t>(std::min<uint64_t>(kMost, 4ull * capacity));
  };
  needed.candidates = of(counts.candidates, needed.candidates);
  needed.unresolvedPairs = std::max(counts.unresolved, 1u);
  needed.searches = self.recorded.searchCount();
  uint32_t rounds = 0;
  while (rounds <= self.capacity.rounds && counts.rounds[rounds].tasks != 0) ++rounds;
  const bool isUnfinished = rounds > self.capacity.rounds;
  needed.rounds =
      isUnfinished ? std::min(2 * self.capacity.rounds, gpu::kMostRounds) : std::max((rounds + 1) / 2 * 2, 2u);
  return needed;
}

AnswerCounts Recorder::answerCounts() const {
  const Impl& self = *impl_;
  AnswerCounts answers;
  answers.isExecuted = self.recorded.isComplete && !self.isPending();
  if (!answers.isExecuted) return answers;
  for (const Result& result : self.recordedResults()) {
    ++answers.byStatus[static_cast<size_t>(result.status)];
    for (size_t bit = 0; bit < answers.byFlag.size(); ++bit) answers.byFlag[bit] += result.flags >> bit & 1;
  }
  return answers;
}

uint64_t Recorder::memoryUse() const {
  return impl_->owner.bytes() + memoryAlone(impl_->copy);
}

std::string Recorder::boundsViolation() const {
  return impl_->isPending() ? "" : impl_->geometry.boundsViolation();
}

}  // namespace radar
