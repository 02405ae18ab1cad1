#include "contact/pass.h"

#include <algorithm>

#include "gpu/api.h"
#include "gpu/barrier.h"
#include "gpu/requirements.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;
using gpu::bytesOf;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
// Kernels bind no more than that; all other lists are bounded by their capacities or by those of searches.
void checkExcluded(const Device::Impl& device, uint64_t count) {
  const uint64_t bytes = count * sizeof(uint32_t), limit = device.properties.limits.maxStorageBufferRange;
  if (bytes <= limit) return;
  throw gpu::LimitError("the lists of excluded objects need a buffer of " + std::to_string(bytes) +
                        " bytes, the device allows " + std::to_string(limit));
}

// A workgroup is one subgroup.
gpu::Program searchOf(const Device::Impl& device, const SearchTuning& tuning, bool hasClearances) {
  const gpu::Shader& shader = hasClearances ? shaders::kSearchWithClearance : shaders::kSearch;
  return {shader,
          {device.subgroupSize, tuning.queue, tuning.stack, tuning.countsWork ? 1u : 0u, tuning.objectSteps,
           tuning.nodeSteps, tuning.few, tuning.leafBatch, tuning.split},
          gpu::Subgroups::full};
}

}  // namespace

std::vector<gpu::Program> ContactPass::programs(const Device::Impl& device) {
  const SearchTuning tuning = tunedFor(device, {});
  std::vector<gpu::Program> all = PairSolver::programs(device);
  all.insert(all.begin(), {searchOf(device, tuning, false), searchOf(device, tuning, true), shaders::kEncode,
                           shaders::kCollect, shaders::kFilter});
  return all;
}

ContactPass::ContactPass(const gpu::Owner& owner, GpuScene& scene, const SearchTuning& tuning)
    : device_(&owner.device()),
      scene_(scene),
      tuning_(tunedFor(owner, tuning)),
      search_(searchOf(owner, tuning_, false)),
      searchWithClearance_(searchOf(owner, tuning_, true)),
      // Rounds alternate between two lists of tasks.
      run_(owner, {shaders::kEncode, search_, search_, shaders::kCollect, shaders::kCollect, shaders::kFilter}),
      upload_(owner),
      stated_(owner, "stated searches", BufferDomain::device, kUploaded),
      sensors_(owner, "sensors", BufferDomain::device, gpu::kAsTexels),
      excluded_(owner, "excluded objects", BufferDomain::device, kUploaded),
      tasks_(owner, "search tasks", BufferDomain::device),
      spilled_(owner, "spilled search tasks", BufferDomain::device),
      queues_(owner, "search queues", BufferDomain::device),
      candidates_(owner, "candidate pairs", BufferDomain::device),
      solver_(owner, scene) {
  if (tuning_.budget == 0) tuning_.budget = kMostBudget;
}

void ContactPass::reserveLists(uint32_t searches, uint32_t results) {
  const VkDeviceSize limit = device_->properties.limits.maxStorageBufferRange;
  const uint64_t tasks = taskRoomFor(tuning_, *device_, searches),
                 candidates = candidateRoomFor(tuning_, searches, wantedCandidates_);
  taskRoom_ = static_cast<uint32_t>(std::min(tasks, limit / sizeof(gpu::SearchTask)));
  candidateRoom_ = static_cast<uint32_t>(std::min(candidates, limit / sizeof(gpu::RefinedPair)));
  tasks_.reserve(taskRoom_);
  spilled_.reserve(taskRoom_);
  queues_.reserve(groupsFor(tuning_, *device_, searches) * 2 * tuning_.queue);
  candidates_.reserve(candidateRoom_);
  solver_.reserve(searches, results, candidateRoom_,
                  unresolvedRoomFor(tuning_, searches, hasClearances_, wantedUnresolved_));
}

void ContactPass::reserve(uint32_t searches, uint32_t results, uint32_t excluded) {
  stated_.reserve(searches);
  sensors_.reserve(searches);
  excluded_.reserve(excluded);
  reserveLists(searches, results);
  constexpr size_t kPerSearch = sizeof(gpu::StatedSearch) + sizeof(gpu::Sweep);
  upload_.reserve(searches * kPerSearch + excluded * sizeof(uint32_t) + results * sizeof(Result) +
                  sizeof(gpu::SearchCounts) + 5 * 8);  // each of five pieces may be rounded up
}

// Begins an upload with the changes of the scene and the counts of a search without tasks.
GpuScene::Staged ContactPass::beginStaging(uint32_t searches, const Scene::Impl& scene, GpuScene::Overwritten next) {
  searchCount_ = searches;
  encoding_ = {.count = searches};
  setAnchor(encoding_, scene.objectTree());
  upload_.begin();
  GpuScene::Staged staged = scene_.stage(scene, std::move(next), upload_);
  solver_.begin(searches, upload_);
  run_.begin();
  return staged;
}

GpuScene::Staged ContactPass::stage(const SearchSource& batch, std::span<const Result> known, const Scene::Impl& scene,
                                    GpuScene::Overwritten next) {
  ignoresLeaving_ = batch.ignoresLeaving;
  hasClearances_ = batch.hasClearances;
  if (hasClearances_) run_.reserve({searchWithClearance_, searchWithClearance_});
  checkExcluded(*device_, batch.excluded.size());
  GpuScene::Staged staged = beginStaging(batch.count, scene, std::move(next));
  const auto results = static_cast<uint32_t>(std::max<size_t>(known.size(), batch.count));
  reserve(searchCount_, results, static_cast<uint32_t>(batch.excluded.size()));
  if (batch.count > 0) {
    std::byte* const stated = upload_.place(batch.count * sizeof(gpu::StatedSearch), stated_, 0);
    std::byte* const sweeps = upload_.place(batch.count * sizeof(gpu::Sweep), solver_.lists().sweeps, 0);
    batch.write(reinterpret_cast<gpu::StatedSearch*>(stated), reinterpret_cast<gpu::Sweep*>(sweeps));
  }
  upload_.add(batch.excluded.data(), batch.excluded.size_bytes(), excluded_);
  upload_.add(known.data(), known.size_bytes(), solver_.lists().results);
  return staged;
}

GpuScene::Staged ContactPass::stageWritten(uint32_t searches, const Scene::Impl& scene, GpuScene::Overwritten next) {
  ignoresLeaving_ = hasClearances_ = false;
  GpuScene::Staged staged = beginStaging(searches, scene, std::move(next));
  reserve(searches, searches, searches);
  return staged;
}

void ContactPass::stageMore(const gpu::SearchCounts& before) {
  gpu::SearchCounts counts = before;
  counts.refinedPairs = counts.leftPairs = counts.openPairs = counts.unresolved = 0;
  for (uint32_t* const groups : {counts.refineGroups, counts.openGroups}) groups[0] = groups[1] = 0;
  const uint32_t tasks = tasksLeft(before);
  std::fill(std::begin(counts.rounds), std::end(counts.rounds), gpu::SearchRound{});
  counts.rounds[0].tasks = tasks;
  upload_.begin();
  upload_.add(&counts, sizeof(counts), solver_.lists().counts);
}

void ContactPass::recordUpload(const gpu::Commands& commands, const OpenStage& stage) {
  stage("upload");
  upload_.record(commands);
  solver_.recordReset(commands);
  gpu::transferToComputeReadWrite(commands);
}

void ContactPass::recordEncoding(const gpu::Commands& commands, const OpenStage& stage) {
  using namespace gpu;  // the slots
  stage("encode");
  run_(commands, shaders::kEncode, gpu::groupsFor(searchCount_, kContactGroup), encoding_,
       {{kSlotMeshes, scene_.buffers().meshes},
        {kSlotObjectNodes, scene_.buffers().objectNodes},
        {kSlotStated, stated_},
        {kSlotSweeps, solver_.lists().sweeps},
        {kSlotSensors, sensors_},
        {kSlotStates, states()},
        {kSlotCounts, counts()},
        {kSlotTasks, tasks_}});
  computeWriteToComputeReadWrite(commands);
}

// `isLast`: searches that this leaves unfinished are abandoned. The caller records the barrier after it.
void ContactPass::recordRound(const gpu::Commands& commands, uint32_t round, bool isLast) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& scene = scene_.buffers();
  // What is waiting when the budget ends takes more iterations then.
  const uint32_t budget = hasClearances_ ? std::max(tuning_.budget / 2, 1u) : tuning_.budget;
  const Array<SearchTask>&from = round % 2 == 0 ? tasks_ : spilled_, &to = round % 2 == 0 ? spilled_ : tasks_;
  run_(commands, hasClearances_ ? searchWithClearance_ : search_, groupsFor(tuning_, *device_, searchCount_),
       SearchPush{round, taskRoom_, candidateRoom_, budget, widthFor(tuning_, *device_, searchCount_)},
       {{kSlotMeshNodes, scene.meshNodes},
        {kSlotObjectNodes, scene.objectNodes},
        {kSlotVertices, scene.vertices},
        {kSlotTriangles, scene.triangles},
        {kSlotPlacements, scene.placements},
        {kSlotSensors, sensors_},
        {kSlotStates, states()},
        {kSlotCounts, counts()},
        {kSlotTasks, from},
        {kSlotSpilled, to},
        {kSlotQueuedPairs, queues_},
        {kSlotCandidatePairs, candidates_},
        {kSlotExcluded, excluded_}});
  computeWriteToComputeReadWrite(commands);
  run_(commands, shaders::kCollect, kCollectGroups, CollectPush{round, taskRoom_, isLast ? 1u : 0u},
       {{kSlotCounts, counts()}, {kSlotStates, states()}, {kSlotTasks, from}, {kSlotSpilled, to}});
}

void ContactPass::record(const gpu::Commands& commands, const OpenStage& stage, uint32_t rounds, bool isLast) {
  using namespace gpu;  // the slots
  const PairSolver::Lists& lists = solver_.lists();
  rounds_ = rounds;
  if (searchCount_ == 0) return;
  stage("search");
  for (uint32_t round = 0; round < rounds; ++round) {
    if (round > 0) computeWriteToComputeReadWrite(commands);
    recordRound(commands, round, isLast && round + 1 == rounds);
  }
  stage("solve");
  computeWriteToIndirect(commands);
  const Groups perCandidates{lists.counts, offsetof(SearchCounts, filterGroups)};
  run_(commands, shaders::kFilter, perCandidates, FilterPush{candidateRoom_},
       {{kSlotStates, lists.states},
        {kSlotCounts, lists.counts},
        {kSlotCandidatePairs, candidates_},
        {kSlotRefinedPairs, lists.refinedPairs}});
  computeWriteToComputeReadWrite(commands);
  solver_.record(commands, stage, perCandidates, true, ignoresLeaving_);
}

bool ContactPass::learn(const gpu::SearchCounts& counts) {
  if (counts.unresolved > solver_.unresolvedRoom()) wantedUnresolved_ = 2 * counts.unresolved;
  // Searches without room ended early, so their actual need is unknown.
  if (counts.candidates <= candidateRoom_ || candidateRoom_ >= kMostCandidates || tuning_.candidates != 0) return false;
  wantedCandidates_ = std::min(4 * candidateRoom_, kMostCandidates);
  return true;
}

}  // namespace radar
