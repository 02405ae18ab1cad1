#include "radar/recorder.h"

#include <algorithm>
#include <limits>
#include <map>

#include "contact/decode.h"
#include "contact/pass.h"
#include "cpu/clearance.h"
#include "cpu/query_search.h"
#include "embed/capacity.h"
#include "embed/gather.h"
#include "embed/host_geometry.h"
#include "embed/host_queries.h"
#include "embed/known_recordings.h"
#include "gpu/barrier.h"
#include "math/float_environment.h"
#include "query/hits.h"
#include "query/route.h"
#include "query/swept.h"
#include "scene/scene_copy.h"

namespace radar {

namespace {

// Excluded objects per query for which memory is reserved in advance.
constexpr uint32_t kExcluded = 8;
constexpr VkDeviceSize kFirstResult = (sizeof(gpu::SearchCounts) + 7) / 8 * 8;
// Of a query past one object each: lavapipe ends longer loops silently.
constexpr size_t kMostSearches = 1u << 15;

SearchRoom roomFor(const Capacity& capacity) {
  return {.candidates = capacity.candidates, .unresolved = capacity.unresolvedPairs};
}

bool searchesEach(const Query& query, const Scene::Impl& scene) {
  return routeOf(query, scene, false) == Route::searchEach;
}

Result outOfRange() {
  Result result;
  result.tier = Tier::contact;
  result.flags = Flag::range;
  return result;
}

}  // namespace

struct Recorder::Impl {
  Impl(const Device::Impl& openDevice, const Scene& ownScene, std::shared_ptr<GpuScene> ownCopy, const Capacity& given)
      : device(openDevice),
        scene(ownScene),
        capacity(completed(given, openDevice)),
        copy(std::move(ownCopy)),
        geometry(openDevice, *copy),
        pass(openDevice, *copy, roomFor(capacity)),
        gathers(openDevice, capacity.searches),
        readback(openDevice, "recorded results", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
    const uint32_t results = capacity.queries + 2 * capacity.searches;  // lists are no longer than what they are from
    pass.reserve(capacity.queries + capacity.searches, results, kExcluded * capacity.queries);
    readback.reserve(kFirstResult + results * sizeof(Result));
  }

  const gpu::SearchCounts& counts() const { return *reinterpret_cast<const gpu::SearchCounts*>(readback.mapped()); }
  void validateAll(std::span<const Query> queries) const;
  void validateHost(const HostQueries& queries, const HostGeometry& hostGeometry) const;
  std::vector<std::vector<ObjectId>> objectsInReach(std::span<const Query> queries);
  void addUnbounded(const Query& query, std::vector<ObjectId>& objects) const;
  void plan(std::span<const Query> queries);
  Planned plan(const Query& query, uint32_t result, ObjectId object);
  void planSearches(const Query& query, std::span<const ObjectId> objects);
  void recordSearch(VkCommandBuffer commandBuffer, uint32_t results, bool areWritten);
  void learnBoxes();
  void decide(std::span<Result> results) const;
  Answers putTogether(std::span<const Result> all) const;
  std::vector<Result> readHost() const;
  std::vector<Result> copyResults(size_t count) const;
  VkDeviceSize firstSweep() const { return kFirstResult + capacity.queries * sizeof(Result); }

  const Device::Impl& device;
  const Scene& scene;
  Capacity capacity;
  std::shared_ptr<GpuScene> copy;
  bool isShared = false;                                 ///< with other recorders
  std::shared_ptr<const GpuScene::Buffers> usedBuffers;  ///< by the last recording
  GpuScene::Farthest farthest;                           ///< of the meshes that it searched
  HostGeometryPass geometry;
  std::optional<HostQueriesPass> hostQueries;  ///< made when first needed
  uint32_t mostWritten = 0;  ///< HostQueries::count of the last record(); 0 if it failed, or had others
  ContactPass pass;
  GatherPass gathers;
  gpu::Buffer readback;                 ///< counts, then results; then sweeps, if a host's shader wrote the queries
  std::vector<Query> recordedQueries;   ///< in the last record(); none if it failed
  std::vector<gpu::Gathered> gathered;  ///< queries that take several searches
  size_t searches = 0;                  ///< past one object each
  std::vector<uint32_t> hitOffsets;
  std::vector<double> tolerances;  ///< of their clearances
  SensorBatch sensors;
  std::vector<gpu::DeformedSensor> deformedSensors;
  std::vector<Result> known;  ///< of queries, their lists, and searches past one object each
};

void Recorder::Impl::validateAll(std::span<const Query> queries) const {
  if (queries.size() > capacity.queries) {
    throw Error("record: expected at most " + std::to_string(capacity.queries) + " queries, got " +
                std::to_string(queries.size()));
  }
  for (size_t i = 0; i < queries.size(); ++i) {
    std::string wrong = validate(queries[i], scene);
    if (const char* what = wrong.empty() ? onlyForCpu(queries[i], scene.impl(), false) : nullptr) {
      wrong = std::string("only the CPU combines ") + what + ": ask a Sweeper";
    }
    if (!wrong.empty()) throw Error("record: query " + std::to_string(i) + ": " + wrong);
  }
}

void Recorder::Impl::validateHost(const HostQueries& queries, const HostGeometry& hostGeometry) const {
  if (std::string wrong = validate(queries, capacity.queries); !wrong.empty()) throw Error("record: queries: " + wrong);
  if (scene.impl().moving > 0) throw Error("record: queries: expected a scene in which no object has a motion");
  if (std::string wrong = validate(hostGeometry, scene); !wrong.empty()) throw Error("record: geometry: " + wrong);
}

// Adds the objects that may be in reach, wherever the host moves them, and sorts all: every object if only the device
// knows how large the sensor is.
void Recorder::Impl::addUnbounded(const Query& query, std::vector<ObjectId>& objects) const {
  const auto add = [&](ObjectId id) {
    if (scene.impl().objects[id].used && takesPart(query, scene.impl(), id)) objects.push_back(id);
  };
  if (geometry.isUnbounded(query.mesh)) {
    for (ObjectId id = 0; id < scene.impl().objects.size(); ++id) add(id);
  } else {
    for (const ObjectId id : geometry.unbounded()) add(id);
  }
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
}

// Of the queries that take several searches; ascending.
std::vector<std::vector<ObjectId>> Recorder::Impl::objectsInReach(std::span<const Query> queries) {
  const ObjectTree& tree = scene.impl().objectTree();
  std::vector<std::vector<ObjectId>> objects(queries.size());
  searches = 0;
  for (size_t i = 0; i < queries.size(); ++i) {
    if (!searchesEach(queries[i], scene.impl()) || !tree.inRange()) continue;
    objects[i] = inReach(queries[i], scene.impl(), tree);
    addUnbounded(queries[i], objects[i]);
    searches += objects[i].size();
    if (objects[i].size() <= kMostSearches) continue;
    throw Error("record: query " + std::to_string(i) + ": expected at most " + std::to_string(kMostSearches) +
                " objects in reach, got " + std::to_string(objects[i].size()));
  }
  if (searches > capacity.searches) {
    throw Error("record: expected at most " + std::to_string(capacity.searches) +
                " searches past one object each (Capacity::searches), got " + std::to_string(searches));
  }
  return objects;
}

// As addSensor().
Planned Recorder::Impl::plan(const Query& query, uint32_t result, ObjectId object) {
  const Planned planned = addSensor(sensors, query, result, scene.impl(), scene.impl().objectTree(), object);
  if (planned == Planned::added && geometry.isUnbounded(query.mesh)) {
    deformedSensors.push_back(deformedSensor(sensors.count() - 1, query, motionPast(query, scene.impl(), object)));
  }
  return planned;
}

void Recorder::Impl::plan(std::span<const Query> queries) {
  const ObjectTree& tree = scene.impl().objectTree();
  const std::vector<std::vector<ObjectId>> objects = objectsInReach(queries);
  sensors.clear();
  deformedSensors.clear();
  gathered.clear();
  gathers.clear();
  hitOffsets.clear();
  auto end = static_cast<uint32_t>(queries.size());
  for (uint32_t i = 0; i < queries.size(); ++i) {
    hitOffsets.push_back(end);
    const auto count = static_cast<uint32_t>(objects[i].size());
    const uint32_t listed = queries[i].hits > 1 ? std::min(queries[i].hits, count) : 0;
    if (count > 0) gathered.push_back({.query = i, .first = 0, .count = count, .list = end, .listed = listed});
    end += listed;
  }
  hitOffsets.push_back(end);
  known.assign(end, clearAnswer());
  auto next = gathered.begin();
  for (uint32_t i = 0; i < queries.size(); ++i) {
    if (objects[i].empty()) {
      if (searchesEach(queries[i], scene.impl()) && tree.inRange()) continue;  // nothing is in reach
      if (plan(queries[i], i, kNone) == Planned::outOfRange) known[i] = outOfRange();
      continue;
    }
    next->first = static_cast<uint32_t>(known.size());
    gathers.add(*next++);
    planSearches(queries[i], objects[i]);
  }
}

void Recorder::Impl::planSearches(const Query& query, std::span<const ObjectId> objects) {
  for (const ObjectId object : objects) {
    const Planned planned = plan(query, static_cast<uint32_t>(known.size()), object);
    known.push_back(planned == Planned::outOfRange ? outOfRange() : clearAnswer());
  }
}

// Of the meshes whose vertices only the device knew: what decide() needs.
void Recorder::Impl::learnBoxes() {
  const std::map<MeshId, Box> boxes = geometry.unboundedBoxes();
  if (boxes.empty()) return;
  std::vector<Vector> all = *farthest;
  for (const auto& [mesh, box] : boxes) {
    Mesh shape;
    setBox(shape, box);
    all[mesh] = shape.farthest;
    for (size_t i = 0; i < tolerances.size(); ++i) {
      if (recordedQueries[i].mesh == mesh) tolerances[i] = cpu::toleranceOf(recordedQueries[i], shape);
    }
  }
  farthest = std::make_shared<const std::vector<Vector>>(std::move(all));
}

// Decides the answers of searches that are open.
void Recorder::Impl::decide(std::span<Result> results) const {
  const UnresolvedPairs unresolved(pass.unresolved(counts()));
  auto next = gathered.begin();
  for (uint32_t i = 0; i < sensors.count(); ++i) {
    const gpu::Sweep& sweep = sensors.sweeps[i];
    while (next != gathered.end() && sweep.result >= next->first + next->count) ++next;
    const bool isOneOfSeveral = sweep.result >= hitOffsets.back();
    const uint32_t number = isOneOfSeveral ? next->query : sweep.result;
    const auto pairs = unresolved.of(i);
    if (results[sweep.result].flags != Flag::unresolved || pairs.empty()) continue;
    const Query& query = recordedQueries[number];
    const Vector drift{sweep.drift[0], sweep.drift[1], sweep.drift[2]};
    results[sweep.result] =
        decideUnresolved(results[sweep.result], pairs, query,
                         query.motion ? Motion(*query.motion, drift) : Motion(query), tolerances[number], *farthest);
  }
}

// Returns the answers to the queries, from all that the device wrote.
Answers Recorder::Impl::putTogether(std::span<const Result> all) const {
  Answers answers = unanswered(recordedQueries);
  std::copy_n(all.begin(), answers.results.size(), answers.results.begin());
  for (const gpu::Gathered& several : gathered) {
    Merged found = merged(all.subspan(several.first, several.count), several.listed);
    answers.results[several.query] = found.first;
    if (!answers.lists.empty()) answers.lists[several.query].hits = std::move(found.hits);
  }
  return answers;
}

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Recorder Recorder::unproved(const Device::Impl& device, const Scene& scene, const Capacity& capacity) {
  return Recorder(std::make_unique<Impl>(device, scene, std::make_shared<GpuScene>(device), capacity));
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

// Records what either kind of record() has staged. `areWritten`: a host's shader has written the queries.
void Recorder::Impl::recordSearch(VkCommandBuffer commandBuffer, uint32_t results, bool areWritten) {
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
    geometry.record(commands, scene.impl());
  }
  if (areWritten && results != 0) {
    stage("plan");
    hostQueries->record(commands, pass, *copy, scene.impl());
  }
  if (!areWritten) geometry.recordReach(commands, pass);
  pass.record(commands, stage, capacity.rounds, true);
  if (!gathers.empty()) {
    stage("gather");
    gathers.record(commands, pass.results(), results - gathers.searchCount());
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
  if (areWritten) readBack(pass.encoded().sweeps, firstSweep(), results * sizeof(gpu::Sweep));
  gpu::writtenToHost(commands);
  device.endLabel(commands);
  copy->confirm(scene.impl());
  geometry.confirm();
  usedBuffers = copy->shareBuffers();
  farthest = copy->farthest();
}

void Recorder::record(VkCommandBuffer commands, std::span<const Query> queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  Impl& self = *impl_;
  self.validateAll(queries);
  if (std::string wrong = validate(geometry, self.scene); !wrong.empty()) throw Error("record: geometry: " + wrong);
  self.recordedQueries.clear();  // if recording fails, read() has nothing to return
  self.mostWritten = 0;
  self.geometry.stage(geometry, self.scene.impl());
  self.plan(queries);
  self.geometry.stageSensors(self.deformedSensors, self.scene.impl());
  self.copy->willOverwrite(self.geometry.overwritten());
  self.usedBuffers.reset();
  self.pass.stage(self.sensors, self.known, self.scene.impl());
  self.gathers.stage();
  self.tolerances.clear();
  for (const Query& query : queries) {
    self.tolerances.push_back(cpu::toleranceOf(query, self.scene.impl().meshes[query.mesh]));
  }
  std::vector<Query> recorded(queries.begin(), queries.end());
  self.recordSearch(commands, static_cast<uint32_t>(self.known.size()), false);  // from here on nothing throws
  self.recordedQueries = std::move(recorded);
}

void Recorder::record(VkCommandBuffer commands, const HostQueries& queries, const HostGeometry& geometry) {
  const FloatEnvironment floats;
  Impl& self = *impl_;
  self.validateHost(queries, geometry);
  self.recordedQueries.clear();
  self.mostWritten = 0;
  self.geometry.stage(geometry, self.scene.impl());
  self.geometry.stageSensors({}, self.scene.impl());
  self.tolerances.clear();
  self.gathers.clear();
  self.gathered.clear();
  self.searches = 0;
  self.hitOffsets.assign(queries.count + 1, queries.count);
  self.copy->willOverwrite(self.geometry.overwritten());
  self.usedBuffers.reset();
  self.pass.stageEncoded(queries.count, self.scene.impl());
  self.readback.reserve(self.firstSweep() + self.capacity.queries * sizeof(gpu::Sweep));
  if (!self.hostQueries) self.hostQueries.emplace(self.device);
  if (queries.count != 0) self.hostQueries->stage(queries);
  self.recordSearch(commands, queries.count, true);
  self.mostWritten = queries.count;
}

void Recorder::reset() {
  impl_->copy->forget();
  impl_->geometry.forget();
}

VkBuffer Recorder::results() const {
  return impl_->pass.results().get();
}

std::vector<Result> Recorder::Impl::copyResults(size_t count) const {
  const auto* results = reinterpret_cast<const Result*>(readback.mapped() + kFirstResult);
  return {results, results + count};
}

std::vector<Result> Recorder::Impl::readHost() const {
  const UnresolvedPairs unresolved(pass.unresolved(counts()));
  const auto* sweeps = reinterpret_cast<const gpu::Sweep*>(readback.mapped() + firstSweep());
  std::vector<Result> results = copyResults(std::min(counts().queries, mostWritten));
  for (uint32_t i = 0; i < results.size(); ++i) {
    const auto pairs = unresolved.of(i);
    if (results[i].flags != Flag::unresolved || pairs.empty()) continue;
    const Query query = queryOf(sweeps[i]);
    results[i] = decideUnresolved(results[i], pairs, query, Motion(query), 0, *farthest);
  }
  return results;
}

std::span<const uint32_t> Recorder::hitOffsets() const {
  return impl_->hitOffsets;
}

Answers Recorder::read() {
  const FloatEnvironment floats;
  Impl& self = *impl_;
  if (self.mostWritten == 0 && self.recordedQueries.empty()) return {};
  self.learnBoxes();
  if (self.mostWritten != 0) return {.results = self.readHost()};
  std::vector<Result> results = self.copyResults(self.known.size());
  self.decide(results);
  return self.putTogether(results);
}

Capacity Recorder::needed() const {
  const Impl& self = *impl_;
  Capacity needed = self.capacity;
  if (self.recordedQueries.empty() && self.mostWritten == 0) return needed;
  const gpu::SearchCounts& counts = self.counts();
  const auto of = [](uint32_t count, uint32_t capacity) {
    constexpr uint64_t kMost = std::numeric_limits<uint32_t>::max();
    return count <= capacity ? std::max(count, 1u) : static_cast<uint32_t>(std::min<uint64_t>(kMost, 4ull * capacity));
  };
  needed.candidates = of(counts.candidates, needed.candidates);
  needed.unresolvedPairs = std::max(counts.unresolved, 1u);
  needed.searches = static_cast<uint32_t>(self.searches);
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
