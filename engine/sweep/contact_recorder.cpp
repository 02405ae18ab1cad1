#include "sweep/contact_recorder.h"

#include <algorithm>

#include "gpu/barrier.h"

// pass     reads           writes   barrier behind it
// -------- --------------- -------- -----------------
// (contact_pass.cpp)                computeWriteToCopy
// readback states, results readback writtenToHost

namespace radar {

namespace {

// Nearly every search ends in the first.
constexpr uint32_t kSearchDispatches = 3;

}  // namespace

ContactRecorder::ContactRecorder(const Device::Impl& device, ResidentScene& resident, bool timestamps,
                                 const ContactRoom& room)
    : device_(&device),
      resident_(resident),
      room_(room),
      submission_(device, timestamps),
      pass_(device, resident, room),
      readback_(device, "contact readback", gpu::Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

const gpu::State* ContactRecorder::states() const {
  return reinterpret_cast<const gpu::State*>(readback_.mapped());
}

const Result* ContactRecorder::results() const {
  return reinterpret_cast<const Result*>(readback_.mapped() +
                                         gpu::Upload::aligned(pass_.searches() * sizeof(gpu::State)));
}

void ContactRecorder::recordReadback(const gpu::Commands& commands) {
  gpu::computeWriteToCopy(commands);
  submission_.stage("readback");
  const VkBufferCopy states{0, 0, pass_.searches() * sizeof(gpu::State)};
  const VkBufferCopy results{0, gpu::Upload::aligned(states.size), pass_.searches() * sizeof(Result)};
  commands->CmdCopyBuffer(commands, pass_.states().get(), readback_.get(), 1, &states);
  commands->CmdCopyBuffer(commands, pass_.tell().results().get(), readback_.get(), 1, &results);
  gpu::writtenToHost(commands);
}

void ContactRecorder::finish(std::vector<StageTime>& stages) {
  const gpu::State* states = this->states();
  const uint32_t count = pass_.searches();
  const auto is = [&](uint32_t progress) {
    return std::any_of(states, states + count, [&](const gpu::State& s) { return s.progress == progress; });
  };
  uint64_t before = 0;
  while (is(gpu::kSearchUnfinished) || is(gpu::kSearchAsksMask) || is(gpu::kSearchMasked)) {
    uint64_t done = 1;
    for (uint32_t i = 0; i < count; ++i) done += uint64_t{states[i].cursor} + states[i].boxPairs + states[i].round;
    const bool asked = pass_.stageMasks(states);
    if (done == before && !asked) throw Error("the contact search makes no progress", VK_ERROR_UNKNOWN);
    before = done;
    submitAgain(stages, {asked, is(gpu::kSearchUnfinished), asked || is(gpu::kSearchMasked)});
  }
  while (!pass_.tell().makeRoom()) submitAgain(stages, {});
}

void ContactRecorder::submitAgain(std::vector<StageTime>& stages, const ContactPass::Again& again) {
  const gpu::Commands commands = submission_.begin();
  pass_.recordAgain(
      commands, [this](const char* name) { submission_.stage(name); }, again, kSearchDispatches);
  recordReadback(commands);
  submission_.submitAndWait();
  submission_.addTimes(stages);
}

// As many as the buffers hold; the others wait.
std::vector<ContactRecorder::Room> ContactRecorder::nextGroup() {
  const uint64_t maxPairs = device_->properties.limits.maxStorageBufferRange / sizeof(gpu::ClusterPair);
  std::vector<Room> group, again;
  uint64_t pairs = 0, contenders = 0;
  for (const Room& room : waiting_) {
    if (room.pairs > maxPairs || room.contenders > pass_.tell().mostOfOne()) {
      refused_.push_back(room.plan);
    } else if (pairs + room.pairs <= maxPairs && contenders + room.contenders <= pass_.tell().mostContenders()) {
      pairs += room.pairs;
      contenders += room.contenders;
      group.push_back(room);
    } else {
      again.push_back(room);
    }
  }
  waiting_ = std::move(again);
  return group;
}

void ContactRecorder::submitGroup(std::span<const ContactPlan* const> plans, const Scene::Impl& scene) {
  group_ = nextGroup();
  if (group_.empty()) return;
  std::vector<ContactPass::Search> searches;
  for (const Room& room : group_) {
    searches.push_back(
        {plans[room.plan], room.pairs, room.contenders, room.hi, static_cast<uint32_t>(searches.size())});
  }
  pass_.stage(searches, {}, scene);
  readback_.reserve(gpu::Upload::aligned(searches.size() * sizeof(gpu::State)) + searches.size() * sizeof(Result));
  const gpu::Commands commands = submission_.begin();
  const auto stage = [this](const char* name) { submission_.stage(name); };
  pass_.recordUpload(commands, stage);
  pass_.record(commands, stage, kSearchDispatches);
  recordReadback(commands);
  submission_.submit();
}

void ContactRecorder::submit(std::span<const ContactPlan* const> plans, const Scene::Impl& scene) {
  refused_.clear();
  waiting_.clear();
  for (size_t i = 0; i < plans.size(); ++i) {
    waiting_.push_back({i, firstPairs(*plans[i], room_), room_.contenders, plans[i]->hi});
  }
  submitGroup(plans, scene);
}

std::vector<size_t> ContactRecorder::collect(std::span<const ContactPlan* const> plans, const Scene::Impl& scene,
                                             std::vector<StageTime>& stages,
                                             const std::function<void(size_t, const Found&)>& found) {
  for (; !group_.empty(); submitGroup(plans, scene)) {
    submission_.wait();
    resident_.confirm(scene);
    submission_.addTimes(stages);
    finish(stages);

    // What outgrew its room goes again, with the room it is known to need.
    const gpu::State* states = this->states();
    const auto& open = pass_.tell().open();
    auto next = open.begin();
    for (uint32_t i = 0; i < group_.size(); ++i) {
      const Room& room = group_[i];
      const auto first = next;
      while (next != open.end() && (*next)->target == i) ++next;
      if (states[i].pairCount > room.pairs || states[i].progress == gpu::kSearchOverflow) {
        // What a search has certainly met bounds the next one, which then keeps few contenders.
        const bool bounded = states[i].hi < room.hi;
        const bool overflow = states[i].pairCount <= room.pairs && !bounded;
        const auto most = static_cast<uint32_t>(pass_.tell().mostOfOne());
        const uint32_t more = room.contenders < most ? std::min(8 * room.contenders, most) : most + 1;  // or refused
        waiting_.push_back({room.plan, std::max<uint64_t>(room.pairs, states[i].pairCount),
                            overflow ? more : room.contenders, std::min(states[i].hi, room.hi)});
      } else {
        found(room.plan, {states[i], results()[i], {first, next}});
      }
    }
  }
  return std::move(refused_);
}

}  // namespace radar
