#include "radar/recorder.h"

#include <algorithm>
#include <limits>

#include "contact/decode.h"
#include "contact/pass.h"
#include "cpu/clearance.h"
#include "embed/host_geometry.h"
#include "gpu/barrier.h"
#include "scene/query_lists.h"

// pass                                            reads           writes   barrier after it
// ----------------------------------------------- --------------- -------- ------------------
// contact/pass.cpp; host_geometry.cpp between its                          computeWriteToCopy
//   upload and search, and after its resolve
// readback                                        counts, results readback writtenToHost

namespace radar {

namespace {

// Excluded objects per query for which memory is reserved in advance.
constexpr uint32_t kExcluded = 8;
constexpr VkDeviceSize kFirstResult = (sizeof(gpu::SearchCounts) + 7) / 8 * 8;

// Capacity of a list, if the host does not choose it.
struct ListRoom {
  uint64_t perQuery;  // what interlocking meshes of some thousand triangles need
  uint64_t most;      // in total, as long as that leaves `least` per query
  uint64_t least;
};
constexpr ListRoom kCandidates{1u << 11, 1u << 20, 64}, kUnresolved{1u << 7, 1u << 15, 4},
    kUnresolvedWithoutDoubles{1u << 10, 1u << 18, 32};  // which leave every contact to the CPU

uint32_t roomOf(const ListRoom& room, uint64_t queries, uint64_t limit) {
  const uint64_t wanted = std::max(std::min(room.perQuery * queries, room.most), room.least * queries);
  return static_cast<uint32_t>(std::clamp<uint64_t>(wanted, 1, limit));
}

Capacity chosen(Capacity capacity, const Device::Impl& device) {
  const uint64_t limit = device.properties.limits.maxStorageBufferRange;
  if (capacity.candidates == 0) {
    capacity.candidates = roomOf(kCandidates, capacity.queries, limit / sizeof(gpu::RefinedPair));
  }
  if (capacity.unresolvedPairs == 0) {
    capacity.unresolvedPairs = roomOf(device.doubles ? kUnresolved : kUnresolvedWithoutDoubles, capacity.queries,
                                      limit / sizeof(gpu::UnresolvedPair));
  }
  return capacity;
}

SearchRoom roomFor(const Capacity& capacity) {
  return {.candidates = capacity.candidates, .unresolved = capacity.unresolvedPairs};
}

Result outOfRange() {
  Result result;
  result.tier = Tier::contact;
  result.flags = kFlagRange;
  return result;
}

}  // namespace

struct Recorder::Impl {
  Impl(const Device::Impl& openDevice, const Scene& ownScene, const Capacity& given)
      : device(openDevice),
        scene(ownScene),
        capacity(chosen(given, openDevice)),
        copy(openDevice),
        geometry(openDevice, copy),
        pass(openDevice, copy, {std::shared_ptr<void>(), &openDevice.shared<ContactKernels>()}, roomFor(capacity)),
        readback(openDevice, "recorded results", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
    checkCapacity();
    pass.reserve(capacity.queries, capacity.queries, kExcluded * capacity.queries);
    readback.reserve(kFirstResult + capacity.queries * sizeof(Result));
  }

  const gpu::SearchCounts& counts() const { return *reinterpret_cast<const gpu::SearchCounts*>(readback.mapped()); }
  void checkCapacity() const;
  void validateAll(std::span<const Query> queries) const;
  void plan(std::span<const Query> queries);

  const Device::Impl& device;
  const Scene& scene;
  Capacity capacity;
  GpuScene copy;
  HostGeometryPass geometry;
  ContactPass pass;
  gpu::Buffer readback;                ///< counts, then results
  std::vector<Query> recordedQueries;  ///< in the last record(); none if it failed
  std::vector<double> tolerances;      ///< of their clearances
  SensorBatch sensors;
  std::vector<Result> known;
};

void Recorder::Impl::checkCapacity() const {
  const uint64_t limit = device.properties.limits.maxStorageBufferRange;
  const auto limitTo = [](const char* what, uint64_t got, uint64_t most) {
    if (got <= most) return;
    throw Error(std::string("Capacity::") + what + ": this device allows " + std::to_string(most) + ", got " +
                std::to_string(got));
  };
  limitTo("queries", capacity.queries, limit / sizeof(gpu::Sweep));
  limitTo("candidates", capacity.candidates, limit / sizeof(gpu::RefinedPair));
  limitTo("rounds", capacity.rounds, gpu::kMostRounds);
  limitTo("unresolvedPairs", capacity.unresolvedPairs, limit / sizeof(gpu::UnresolvedPair));
  if (capacity.rounds == 0 || capacity.rounds % 2 != 0) {
    throw Error("Capacity::rounds: expected an even number of at least 2, got " + std::to_string(capacity.rounds));
  }
}

void Recorder::Impl::validateAll(std::span<const Query> queries) const {
  if (queries.size() > capacity.queries) {
    throw Error("record: expected at most " + std::to_string(capacity.queries) + " queries, got " +
                std::to_string(queries.size()));
  }
  for (size_t i = 0; i < queries.size(); ++i) {
    std::string wrong = validate(queries[i], scene);
    if (wrong.empty() && queries[i].mode != Mode::contact) wrong = "mode: expected contact";
    const bool combines = queries[i].clearance > 0 && queries[i].ignoreLeaving;
    if (wrong.empty() && (hasLists(queries[i]) || combines || isStep(queries[i], scene.impl()))) {
      wrong =
          "skipOverlapping, hits, motion, clearance with ignoreLeaving: only a Sweeper, a CpuSweeper and a Pool offer "
          "these";
    }
    if (!wrong.empty()) throw Error("record: query " + std::to_string(i) + ": " + wrong);
  }
}

void Recorder::Impl::plan(std::span<const Query> queries) {
  const ObjectTree& tree = scene.impl().objectTree();
  sensors.clear();
  known.clear();
  for (uint32_t i = 0; i < queries.size(); ++i) {
    const Planned planned = addSensor(sensors, queries[i], i, scene.impl(), tree);
    known.push_back(planned == Planned::outOfRange ? outOfRange() : clearAnswer());
  }
}

Recorder::Recorder(const Device& device, const Scene& scene, const Capacity& capacity)
    : impl_(std::make_unique<Impl>(device.impl(), scene, capacity)) {}
Recorder::~Recorder() = default;
Recorder::Recorder(Recorder&&) noexcept = default;
Recorder& Recorder::operator=(Recorder&&) noexcept = default;

void Recorder::record(VkCommandBuffer commandBuffer, std::span<const Query> queries, const HostGeometry& geometry) {
  Impl& self = *impl_;
  self.validateAll(queries);
  if (std::string wrong = validate(geometry, self.scene); !wrong.empty()) throw Error("record: geometry: " + wrong);
  self.recordedQueries.clear();  // if recording fails, read() has nothing to return
  self.geometry.stage(geometry, self.scene.impl());
  self.plan(queries);
  self.copy.willOverwrite(self.geometry.overwritten());
  self.pass.stage(self.sensors, self.known, self.scene.impl());

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
    self.geometry.record(commands);
  }
  self.pass.record(commands, stage, self.capacity.rounds, true);
  if (!self.geometry.empty()) {
    self.geometry.recordInvalidate(commands, self.pass.results(), static_cast<uint32_t>(queries.size()));
  }
  gpu::computeWriteToCopy(commands);
  stage("readback");
  const VkBufferCopy counts{0, 0, sizeof(gpu::SearchCounts)};
  commands->CmdCopyBuffer(commands, self.pass.counts().get(), self.readback.get(), 1, &counts);
  const VkBufferCopy results{0, kFirstResult, queries.size() * sizeof(Result)};
  if (results.size != 0) {
    commands->CmdCopyBuffer(commands, self.pass.results().get(), self.readback.get(), 1, &results);
  }
  gpu::writtenToHost(commands);
  self.device.endLabel(commands);
  self.copy.confirm(self.scene.impl());
  self.recordedQueries.assign(queries.begin(), queries.end());
  self.tolerances.clear();
  for (const Query& query : queries) {
    self.tolerances.push_back(cpu::toleranceOf(query, self.scene.impl().meshes[query.mesh]));
  }
}

void Recorder::reset() {
  impl_->copy.forget();
}

VkBuffer Recorder::results() const {
  return impl_->pass.results().get();
}

std::vector<Result> Recorder::read() {
  Impl& self = *impl_;
  std::vector<Result> results(self.recordedQueries.size());
  if (results.empty()) return results;
  std::copy_n(reinterpret_cast<const Result*>(self.readback.mapped() + kFirstResult), results.size(), results.begin());
  const UnresolvedPairs unresolved(self.pass.unresolved(self.counts()));
  for (uint32_t i = 0; i < self.sensors.count(); ++i) {
    const uint32_t query = self.sensors.sweeps[i].result;
    const auto pairs = unresolved.of(i);
    if (results[query].flags != kFlagUnresolved || pairs.empty()) continue;
    results[query] = decideUnresolved(results[query], pairs, self.recordedQueries[query],
                                      Motion(self.recordedQueries[query]), self.tolerances[query], self.copy);
  }
  return results;
}

Capacity Recorder::needed() const {
  const Impl& self = *impl_;
  Capacity needed = self.capacity;
  if (self.recordedQueries.empty()) return needed;
  const gpu::SearchCounts& counts = self.counts();
  const auto of = [](uint32_t count, uint32_t capacity) {
    constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max();
    return count <= capacity ? std::max(count, 1u) : static_cast<uint32_t>(std::min<uint64_t>(kMost, 4ull * capacity));
  };
  needed.candidates = of(counts.candidates, needed.candidates);
  needed.unresolvedPairs = std::max(counts.unresolved, 1u);
  uint32_t rounds = 0;
  while (rounds <= self.capacity.rounds && counts.rounds[rounds].tasks != 0) ++rounds;
  const bool isUnfinished = rounds > self.capacity.rounds;
  needed.rounds =
      isUnfinished ? std::min(2 * self.capacity.rounds, gpu::kMostRounds) : std::max((rounds + 1) / 2 * 2, 2u);
  return needed;
}

std::string Recorder::boundsViolation() const {
  return impl_->geometry.boundsViolation();
}

}  // namespace radar
