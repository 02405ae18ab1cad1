#include "embed/host_queries.h"

#include <algorithm>
#include <cstddef>

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "spirv/radar_shaders.h"

namespace radar {

namespace {

static_assert(offsetof(HostQuery, direction) == gpu::kQueryDirection &&
              offsetof(HostQuery, distance) == gpu::kQueryDistance && offsetof(HostQuery, mesh) == gpu::kQueryMesh &&
              offsetof(HostQuery, mask) == gpu::kQueryMask && offsetof(HostQuery, exclude) == gpu::kQueryExclude &&
              offsetof(HostQuery, flags) == gpu::kQueryFlags && HostQuery::kAnyHit == gpu::kQueryAnyHit);

// Sets what the shader needs of the tree over objects.
void describe(const ObjectTree& tree, gpu::PlanPush& push) {
  push.inRange = tree.inRange() ? 1 : 0;
  push.start = tree.nodes().empty() ? gpu::kNobody : gpu::kWholeTree;
}

}  // namespace

std::string validate(const HostQueries& queries, uint32_t most) {
  if (queries.buffer == VK_NULL_HANDLE) return "expected a buffer";
  if (queries.stride < sizeof(HostQuery)) {
    return "stride: expected at least " + std::to_string(sizeof(HostQuery)) + " bytes, got " +
           std::to_string(queries.stride);
  }
  if (queries.count > most) {
    return "count: expected at most " + std::to_string(most) + ", got " + std::to_string(queries.count);
  }
  return {};
}

HostQueriesPass::HostQueriesPass(const gpu::Owner& owner)
    : device_(&owner.device()),
      run_(owner, {shaders::kPlan}),
      words_(owner, "host queries", gpu::BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

void HostQueriesPass::stage(const HostQueries& queries) {
  const VkDeviceSize span = gpu::roundedUp(spanOf(queries.stride, queries.count, sizeof(HostQuery)), 8);
  // Then the number of queries, and the word after the last that a shader may load.
  const VkDeviceSize bytes = span + 2 * sizeof(uint32_t);
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  if (std::max(bytes, queries.count * sizeof(gpu::Sensor)) > limit) {
    throw Error("the host's queries, or their sensors, exceed the " + std::to_string(limit) +
                " bytes of the device's maxStorageBufferRange");
  }
  words_.reserve(bytes / sizeof(uint32_t));
  run_.begin();
  queries_ = queries;
  span_ = span;
}

void HostQueriesPass::record(const gpu::Commands& commands, const ContactPass& search, const GpuScene& resident,
                             const Scene::Impl& scene) {
  const VkBufferCopy all{queries_.first, 0, spanOf(queries_.stride, queries_.count, sizeof(HostQuery))};
  commands->CmdCopyBuffer(commands, queries_.buffer, words_.get(), 1, &all);
  const bool isCounted = queries_.countBuffer != VK_NULL_HANDLE;
  if (isCounted) {
    const VkBufferCopy number{queries_.countOffset, span_, sizeof(uint32_t)};
    commands->CmdCopyBuffer(commands, queries_.countBuffer, words_.get(), 1, &number);
  }
  gpu::transferToComputeReadWrite(commands);
  const ContactPass::Stated to = search.stated();
  gpu::PlanPush push{.queries = queries_.count,
                     .stride = static_cast<uint32_t>(queries_.stride),
                     .countByte = isCounted ? static_cast<uint32_t>(span_) : gpu::kNobody,
                     .meshes = static_cast<uint32_t>(scene.meshes.size())};
  describe(scene.objectTree(), push);
  run_(commands, shaders::kPlan, gpu::groupsFor(queries_.count, gpu::kHostGroup), push,
       {{gpu::kSlotWords, words_},
        {gpu::kSlotMeshes, resident.buffers().meshes},
        {gpu::kSlotStated, to.searches},
        {gpu::kSlotSweeps, to.sweeps},
        {gpu::kSlotExcluded, to.excluded},
        {gpu::kSlotCounts, search.counts()}});
  gpu::computeWriteToComputeReadWrite(commands);
}

Query queryOf(const gpu::Sweep& sweep) {
  Query query;
  std::copy(std::begin(sweep.pose), std::end(sweep.pose), query.worldFromMesh.m.begin());
  std::copy(std::begin(sweep.direction), std::end(sweep.direction), query.direction.begin());
  query.distance = sweep.distance;
  query.anyHit = sweep.anyHit != 0;
  return query;
}

}  // namespace radar
