#include "sweep/tell_recorder.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <tuple>

#include "gpu/barrier.h"
#include "spirv/tell_comp.h"
#include "spirv/tell_comp_RADAR_NO_DOUBLES.h"

// pass   reads                              writes         barrier behind it
// ------ ---------------------------------- -------------- -----------------------
// empty                                     open's count   transferToComputeReadWrite
// tell   scene, targets, states, contenders results, open  (the caller's)

namespace radar {

using gpu::Residence;

namespace {

struct TellPush {
  uint32_t count, groupsX, openCapacity;
};

std::vector<gpu::Binding> bindingList() {
  std::vector<gpu::Binding> list;
  for (const uint32_t number :
       {gpu::kBindOriginals, gpu::kBindIndices, gpu::kBindMeshes, gpu::kBindObjects, gpu::kBindTargets,
        gpu::kBindStates, gpu::kBindContenders, gpu::kBindSlotIds, gpu::kBindResults, gpu::kBindOpenContenders}) {
    list.push_back({number, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  }
  return list;
}

std::span<const uint32_t> shader(const Device::Impl& device) {
  if (device.doubles) return k_tell_comp;
  return k_tell_comp_RADAR_NO_DOUBLES;
}

VkDeviceSize bytesFor(uint32_t openContenders) {
  return sizeof(gpu::OpenCount) + openContenders * sizeof(gpu::OpenContender);
}

}  // namespace

TellRecorder::TellRecorder(const Device::Impl& device, const ResidentScene& resident, uint32_t openContenders)
    : device_(&device),
      resident_(resident),
      lanes_(std::clamp(device.subgroupSize, 8u, 128u)),
      bindings_(device, bindingList(), sizeof(TellPush)),
      pipeline_(gpu::computePipeline(device, bindings_.layout(), shader(device), "tell", std::array{lanes_})),
      results_(
          device, "results", Residence::device,
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      open_(device, "open contenders", Residence::readback,
            VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  open_.reserve(bytesFor(openContenders));
}

uint64_t TellRecorder::mostContenders() const {
  return (device_->properties.limits.maxStorageBufferRange - sizeof(gpu::OpenCount)) / sizeof(gpu::OpenContender);
}

uint64_t TellRecorder::mostOfOne() const {
  return std::min<uint64_t>(mostContenders(), uint64_t{gpu::kMostListed} * lanes_);
}

void TellRecorder::prepare(uint32_t results) {
  results_.reserve(results * sizeof(Result));
}

uint32_t TellRecorder::capacity() const {
  const VkDeviceSize bytes = std::min<VkDeviceSize>(open_.capacity(), device_->properties.limits.maxStorageBufferRange);
  return static_cast<uint32_t>((bytes - sizeof(gpu::OpenCount)) / sizeof(gpu::OpenContender));
}

void TellRecorder::record(const gpu::Commands& commands, const Lent& lent, uint32_t targets) {
  commands->CmdFillBuffer(commands, open_.get(), 0, sizeof(gpu::OpenCount), 0);
  gpu::transferToComputeReadWrite(commands);
  const ResidentScene::Buffers& scene = resident_.buffers();
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {
      {gpu::kBindOriginals, &scene.originals}, {gpu::kBindIndices, &scene.indices},
      {gpu::kBindMeshes, &scene.meshes},       {gpu::kBindObjects, &scene.objects},
      {gpu::kBindSlotIds, &scene.triangleIds}, {gpu::kBindTargets, &lent.targets},
      {gpu::kBindStates, &lent.states},        {gpu::kBindContenders, &lent.contenders},
      {gpu::kBindResults, &results_},          {gpu::kBindOpenContenders, &open_}};
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
  bindings_.bind(commands);
  const TellPush push{targets, std::min(targets, 65535u), capacity()};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (targets + push.groupsX - 1) / push.groupsX, 1);
}

const gpu::OpenCount& TellRecorder::count() const {
  return *reinterpret_cast<const gpu::OpenCount*>(open_.mapped());
}

bool TellRecorder::allListed() const {
  return count().count <= capacity();
}

bool TellRecorder::makeRoom() {
  if (allListed()) return true;
  assert(count().count <= mostContenders());
  open_.reserve(bytesFor(count().count));
  return false;
}

const std::vector<const gpu::OpenContender*>& TellRecorder::open() {
  const auto* first = reinterpret_cast<const gpu::OpenContender*>(open_.mapped() + sizeof(gpu::OpenCount));
  ordered_.resize(std::min(count().count, capacity()));
  for (size_t i = 0; i < ordered_.size(); ++i) ordered_[i] = first + i;
  const auto name = [](const gpu::OpenContender* c) { return std::tie(c->target, c->object, c->triB, c->triA); };
  std::sort(ordered_.begin(), ordered_.end(), [&](const auto* p, const auto* q) { return name(p) < name(q); });
  return ordered_;
}

}  // namespace radar
