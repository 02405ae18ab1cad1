#include "contact/pair_solver.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

constexpr VkBufferUsageFlags kReadBack = VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

// Those that need doubles.
const std::initializer_list<gpu::Program> kPrecise = {shaders::kCertify, shaders::kRefine, shaders::kSeparate,
                                                      shaders::kProve,   shaders::kBlock,  shaders::kDescribe};

}  // namespace

std::vector<gpu::Program> PairSolver::programs(const Device::Impl& device) {
  std::vector<gpu::Program> all{shaders::kLink, shaders::kResolve};
  if (device.doubles) all.insert(all.end(), kPrecise);
  return all;
}

PairSolver::PairSolver(const gpu::Owner& owner, GpuScene& scene)
    : device_(&owner.device()),
      scene_(scene),
      run_(owner, {shaders::kLink, shaders::kResolve}),
      lists_{.sweeps{owner, "sweeps", BufferDomain::device, kReadBack},
             .states{owner, "search states", BufferDomain::device},
             .refinedPairs{owner, "refined pairs", BufferDomain::device},
             .counts{owner, "search counts", BufferDomain::device, kReadBack | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT},
             .results{owner, "results", BufferDomain::device, kReadBack}},
      heads_(owner, "refined pair lists", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      unresolved_(owner, "unresolved pairs", BufferDomain::readback) {
  if (owner.device().doubles) run_.reserve(kPrecise);
}

void PairSolver::reserve(uint32_t searches, uint32_t results, uint32_t pairs, uint32_t unresolved) {
  const VkDeviceSize limit = device_->properties.limits.maxStorageBufferRange;
  unresolvedRoom_ = static_cast<uint32_t>(std::min<uint64_t>(unresolved, limit / sizeof(gpu::UnresolvedPair)));
  lists_.counts.reserve(1);
  lists_.sweeps.reserve(searches);
  lists_.states.reserve(searches);
  heads_.reserve(searches);
  lists_.results.reserve(results);
  lists_.refinedPairs.reserve(pairs);
  unresolved_.reserve(unresolvedRoom_);
}

void PairSolver::begin(uint32_t searches, gpu::Upload& upload) {
  searchCount_ = searches;
  gpu::SearchCounts counts{.serial = ++serial_};
  counts.refineGroups[2] = counts.openGroups[2] = 1;
  lists_.counts.reserve(1);
  upload.add(&counts, sizeof(counts), lists_.counts);
  run_.begin();
}

void PairSolver::recordReset(const gpu::Commands& commands) {
  commands->CmdFillBuffer(commands, heads_.get(), 0, VK_WHOLE_SIZE, gpu::kNobody);
}

void PairSolver::record(const gpu::Commands& commands, const OpenStage& stage, const gpu::Groups& pairs,
                        bool areCertified, bool ignoresLeaving) {
  using namespace gpu;  // the slots
  const GpuScene::Buffers& scene = scene_.buffers();
  if (device_->doubles) {
    const Groups left{lists_.counts, offsetof(SearchCounts, refineGroups)};
    const Groups open{lists_.counts, offsetof(SearchCounts, openGroups)};
    const std::pair<const Shader&, const Groups&> steps[] = {
        {shaders::kCertify, pairs}, {shaders::kRefine, left}, {shaders::kSeparate, open}};
    for (const auto& [shader, groups] : steps) {
      const bool certifies = &shader == &shaders::kCertify;
      if (certifies && !areCertified) continue;
      if (!certifies) computeWriteToIndirect(commands);
      run_(commands, shader, groups,
           {{kSlotStates, lists_.states},
            {kSlotCounts, lists_.counts},
            {kSlotRefinedPairs, lists_.refinedPairs},
            {kSlotVertices, scene.vertices},
            {kSlotTriangles, scene.triangles},
            {kSlotSweeps, lists_.sweeps},
            {kSlotObjects, scene.objects}});
    }
    for (const Shader* shader : {&shaders::kProve, &shaders::kBlock}) {
      if (!ignoresLeaving) break;
      computeWriteToIndirect(commands);
      run_(commands, *shader, open,
           {{kSlotStates, lists_.states},
            {kSlotCounts, lists_.counts},
            {kSlotRefinedPairs, lists_.refinedPairs},
            {kSlotVertices, scene.vertices},
            {kSlotTriangles, scene.triangles},
            {kSlotSweeps, lists_.sweeps},
            {kSlotObjects, scene.objects},
            {kSlotMeshes, scene.meshes}});
    }
    computeWriteToComputeReadWrite(commands);
  }
  run_(commands, shaders::kLink, pairs,
       {{kSlotStates, lists_.states},
        {kSlotHeads, heads_},
        {kSlotCounts, lists_.counts},
        {kSlotRefinedPairs, lists_.refinedPairs}});
  computeWriteToComputeReadWrite(commands);
  stage("resolve");
  for (const Shader* shader : {&shaders::kResolve, &shaders::kDescribe}) {
    if (shader == &shaders::kDescribe) {
      if (!device_->doubles) break;
      computeWriteToComputeReadWrite(commands);
    }
    run_(commands, *shader, gpu::groupsFor(searchCount_, kContactGroup), ResolvePush{searchCount_, unresolvedRoom_},
         {{kSlotStates, lists_.states},
          {kSlotHeads, heads_},
          {kSlotCounts, lists_.counts},
          {kSlotRefinedPairs, lists_.refinedPairs},
          {kSlotVertices, scene.vertices},
          {kSlotTriangles, scene.triangles},
          {kSlotSweeps, lists_.sweeps},
          {kSlotObjects, scene.objects},
          {kSlotResults, lists_.results},
          {kSlotUnresolved, unresolved_}});
  }
}

std::span<const gpu::UnresolvedPair> PairSolver::unresolved(const gpu::SearchCounts& counts) const {
  return {unresolved_.mapped(), std::min(counts.unresolved, unresolvedRoom_)};
}

}  // namespace radar
