// A recorder in a host's command buffers.
#pragma once

#include <algorithm>
#include <new>

#include "contact/pass.h"
#include "embed/gather.h"
#include "embed/host_geometry.h"
#include "embed/host_queries.h"
#include "embed/recorded.h"
#include "radar/recorder.h"

namespace radar {

struct Recorder::Impl {
  static constexpr VkDeviceSize kFirstResult = PairSolver::kFirstResult;

  /// Of a device that need not have proved itself.
  Impl(const Device::Impl& device, const Scene& scene, std::shared_ptr<GpuScene> copy, const Capacity& capacity);

  /// Enlarges it; what it has then is of no recording.
  void makeReadback(VkDeviceSize bytes) {
    if (readback.reserve(bytes)) new (readback.mapped()) gpu::SearchCounts{};
  }
  /// Whether the commands recorded last have not been executed.
  bool isPending() const { return recorded.isComplete && counts().serial != serial; }
  void requireExecuted(const char* call) const {
    if (!isPending()) return;
    throw Error(std::string(call) +
                ": the last recording has not been executed: wait for it, or reset() if it never is");
  }
  const gpu::SearchCounts& counts() const { return *reinterpret_cast<const gpu::SearchCounts*>(readback.mapped()); }
  /// Of queries, as the device wrote them; of a host's queries, those that count.
  std::span<const Result> recordedResults() const {
    const uint32_t count = recorded.isWritten ? std::min(counts().queries, recorded.count) : recorded.count;
    return {reinterpret_cast<const Result*>(readback.mapped() + kFirstResult), count};
  }
  void validateAll(std::span<const Query> queries) const;
  void validateHost(const HostQueries& queries, const HostGeometry& hostGeometry) const;
  /// What both kinds of record() do before they record.
  GpuScene::Staged stage(std::span<const Query> queries, const HostGeometry& hostGeometry);
  GpuScene::Staged stage(const HostQueries& queries, const HostGeometry& hostGeometry);
  /// The same, on behalf of a call, which an Error that is of the call names first. `queries`: Queries or HostQueries.
  template <class Queries>
  GpuScene::Staged stageFor(const char* call, const Queries& queries, const HostGeometry& hostGeometry) {
    requireExecuted(call);
    try {
      return stage(queries, hostGeometry);
    } catch (const Error& error) {
      if (error.kind != Error::Kind::call) throw;
      throw Error(std::string(call) + ": " + error.what());
    }
  }
  void begin(const HostGeometry& hostGeometry);
  void upload();
  void recordSearch(VkCommandBuffer commandBuffer, GpuScene::Staged staged);
  template <class Queries>
  void record(VkCommandBuffer commands, const Queries& queries, const HostGeometry& hostGeometry) {
    recordSearch(commands, stageFor("record", queries, hostGeometry));  // from here on nothing throws
  }
  Answers read();
  VkDeviceSize firstSweep() const { return kFirstResult + capacity.queries * sizeof(Result); }

  const Device::Impl& device;
  const gpu::Owner owner;
  const Scene& scene;
  Capacity capacity;
  std::shared_ptr<GpuScene> copy;
  bool isShared = false;                                 ///< with other recorders
  std::shared_ptr<const GpuScene::Buffers> usedBuffers;  ///< by the last recording
  HostGeometryPass geometry;
  std::optional<HostQueriesPass> hostQueries;  ///< made when first needed
  ContactPass pass;
  GatherPass gathers;
  gpu::Buffer readback;  ///< counts, then results; then sweeps, if a host's shader wrote the queries
  Recorded recorded;     ///< the last record()
  uint32_t serial = 0;   ///< SearchCounts::serial of it
};

}  // namespace radar
