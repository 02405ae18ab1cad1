#include "radar/recorder.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "sweep/contact_decode.h"
#include "sweep/contact_pass.h"
#include "sweep/decode.h"
#include "sweep/host_geometry.h"
#include "sweep/sweeper.h"

// pass     reads   writes   barrier behind it
// -------- ------- -------- -----------------
// (contact_pass.cpp, between them host_geometry.cpp)
//                           computeWriteToCopy
// readback results readback writtenToHost

namespace radar {

namespace {

ContactRoom roomFor(const Capacity& capacity) {
  return {.contenders = capacity.contenders, .openContenders = capacity.openPairs, .way = ContactWay::direct};
}

Result refused(uint32_t flags) {
  Result result;
  result.tier = Tier::contact;
  result.flags = flags;
  return result;
}

// Cuts queries to what there is room for.
class Room {
 public:
  explicit Room(const Capacity& capacity) : capacity_(capacity) {}

  /// Returns the flag of what is too small, or 0 and sets the search's room.
  uint32_t give(ContactPass::Search& search, const ContactRoom& first) {
    const ContactPlan& plan = *search.plan;
    const uint64_t clusters = plan.sensor.size() + plan.scene.size();
    if (clusters_ + clusters > capacity_.clusters) return kFlagClusters;
    search.pairs = std::min(firstPairs(plan, first), capacity_.clusterPairs - pairs_);
    if (search.pairs == 0) return kFlagClusterPairs;
    search.contenders = capacity_.contenders;
    clusters_ += clusters;
    pairs_ += search.pairs;
    return 0;
  }

 private:
  Capacity capacity_;
  uint64_t clusters_ = 0, pairs_ = 0;
};

}  // namespace

struct Recorder::Impl {
  Impl(const Device::Impl& openDevice, const Scene& ownScene, const Capacity& given)
      : device(openDevice),
        scene(ownScene),
        capacity(given),
        copy(openDevice),
        geometry(openDevice, copy.resident),
        pass(openDevice, copy.resident, roomFor(given)),
        readback(openDevice, "recorded results", gpu::Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
    refuseTooLarge();
    pass.reserve(capacity);
    readback.reserve(capacity.queries * sizeof(Result));
  }

  void refuseTooLarge();
  void refuseWrong(const char* call, std::span<const Query> queries) const;
  void plan(std::span<const Query> queries);

  const Device::Impl& device;
  const Scene& scene;
  Capacity capacity;
  SceneCopy copy;
  HostGeometryPass geometry;
  ContactPass pass;
  gpu::Buffer readback;
  std::vector<Query> asked;  ///< in the last record(); none if it failed
  std::vector<ContactPlan> plans;
  std::vector<Result> known;
  std::vector<ContactPass::Search> searches;
};

void Recorder::Impl::refuseTooLarge() {
  const uint64_t limit = device.properties.limits.maxStorageBufferRange;
  const auto refuse = [](const char* what, uint64_t got, uint64_t most) {
    if (got <= most) return;
    throw Error(std::string("Capacity::") + what + ": this device allows " + std::to_string(most) + ", got " +
                std::to_string(got));
  };
  refuse("contenders", capacity.contenders, pass.tell().mostOfOne());
  refuse("contenders for all queries", uint64_t{capacity.queries} * capacity.contenders,
         limit / sizeof(gpu::Contender));
  refuse("clusters", capacity.clusters, limit / sizeof(gpu::Placement));
  refuse("clusterPairs", capacity.clusterPairs, limit / sizeof(gpu::ClusterPair));
  refuse("openPairs", capacity.openPairs, pass.tell().mostContenders());
}

void Recorder::Impl::refuseWrong(const char* call, std::span<const Query> queries) const {
  for (size_t i = 0; i < queries.size(); ++i) {
    std::string wrong = whatIsWrong(queries[i], scene);
    if (wrong.empty() && queries[i].mode != Mode::contact) wrong = "mode: expected contact";
    if (wrong.empty() && queries[i].tolerance != 0) wrong = "tolerance: expected 0";
    if (!wrong.empty()) throw Error(std::string(call) + ": query " + std::to_string(i) + ": " + wrong);
  }
}

void Recorder::Impl::plan(std::span<const Query> queries) {
  copy.hierarchy.update(scene.impl());
  plans.clear();
  for (const Query& query : queries) plans.push_back(planContact(query, scene.impl(), copy.hierarchy));
}

Recorder::Recorder(const Device& device, const Scene& scene, const Capacity& capacity)
    : impl_(std::make_unique<Impl>(device.impl(), scene, capacity)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

Capacity Recorder::need(std::span<const Query> queries) {
  impl_->refuseWrong("need", queries);
  impl_->plan(queries);
  Capacity need;
  uint64_t clusters = 0, pairs = 0;
  for (const ContactPlan& plan : impl_->plans) {
    clusters += plan.sensor.size() + plan.scene.size();
    pairs += allPairs(plan);
  }
  need.queries = static_cast<uint32_t>(queries.size());
  need.clusters = static_cast<uint32_t>(std::min<uint64_t>(clusters, UINT32_MAX));
  need.clusterPairs = static_cast<uint32_t>(std::min<uint64_t>(pairs, UINT32_MAX));
  return need;
}

void Recorder::record(VkCommandBuffer commandBuffer, std::span<const Query> queries, const HostGeometry& geometry) {
  Impl& self = *impl_;
  if (queries.size() > self.capacity.queries) {
    throw Error("record: expected at most " + std::to_string(self.capacity.queries) + " queries, got " +
                std::to_string(queries.size()));
  }
  self.refuseWrong("record", queries);
  if (std::string wrong = whatIsWrong(geometry, self.scene); !wrong.empty()) throw Error("record: geometry: " + wrong);
  self.asked.clear();  // until all is recorded there is nothing to read
  self.geometry.stage(geometry, self.scene.impl());
  self.plan(queries);
  if (!self.geometry.empty()) {
    for (ContactPlan& plan : self.plans) self.geometry.prepare(plan);
  }
  self.known.assign(queries.size(), decodeClear());
  self.searches.clear();
  Room room(self.capacity);
  for (uint32_t i = 0; i < queries.size(); ++i) {
    const ContactPlan& plan = self.plans[i];
    if (plan.scene.empty()) continue;
    ContactPass::Search search{&plan, 0, 0, plan.hi, i};
    const uint32_t flag = room.give(search, roomFor(self.capacity));
    self.known[i] = refused(flag);
    if (flag == 0) self.searches.push_back(search);
  }
  self.copy.resident.willOverwrite(self.geometry.overwritten());
  self.pass.stage(self.searches, self.known, self.scene.impl());

  const gpu::Commands commands{&self.device.vk, commandBuffer};
  const char* open = nullptr;
  const auto stage = [&](const char* name) {
    if (open != nullptr) self.device.endLabel(commands);
    self.device.beginLabel(commands, name);
    open = name;
  };
  self.pass.recordUpload(commands, stage);
  if (!self.geometry.empty()) {
    stage("geometry");
    self.geometry.record(commands, self.pass.placements(), self.pass.placementCount(), self.pass.tell().results());
  }
  self.pass.record(commands, stage, self.capacity.dispatches);
  if (!self.geometry.empty()) self.geometry.recordRefusal(commands, static_cast<uint32_t>(queries.size()));
  gpu::computeWriteToCopy(commands);
  stage("readback");
  const VkBufferCopy region{0, 0, queries.size() * sizeof(Result)};
  if (region.size != 0) {
    commands->CmdCopyBuffer(commands, self.pass.tell().results().get(), self.readback.get(), 1, &region);
  }
  gpu::writtenToHost(commands);
  self.device.endLabel(commands);
  self.copy.resident.confirm(self.scene.impl());
  self.asked.assign(queries.begin(), queries.end());
}

void Recorder::reset() {
  impl_->copy.resident.forget();
}

VkBuffer Recorder::results() const {
  return impl_->pass.tell().results().get();
}

std::vector<Result> Recorder::read() {
  Impl& self = *impl_;
  std::vector<Result> results(self.asked.size());
  std::copy_n(reinterpret_cast<const Result*>(self.readback.mapped()), results.size(), results.begin());
  if (results.empty() || self.searches.empty() || !self.pass.tell().allListed()) return results;
  const auto& open = self.pass.tell().open();
  auto next = open.begin();
  for (uint32_t i = 0; i < self.searches.size(); ++i) {
    const auto first = next;
    while (next != open.end() && (*next)->target == i) ++next;
    const uint32_t query = self.searches[i].result;
    if (results[query].flags != kFlagOpen) continue;
    uint64_t cpuPairs = 0;
    results[query] = decodeContact({{}, results[query], {first, next}}, self.asked[query], cpuPairs);
  }
  return results;
}

std::string Recorder::stray() const {
  return impl_->geometry.stray();
}

}  // namespace radar
