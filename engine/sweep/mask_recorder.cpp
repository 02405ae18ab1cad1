#include "sweep/mask_recorder.h"

#include <algorithm>
#include <array>

#include "gpu/barrier.h"
#include "spirv/mask_comp.h"

// pass         reads                                      writes             barrier behind it
// ------------ ------------------------------------------ ------------------ ------------------------------
// mask scene   scene, targets, placements, refs, states,  F                  computeWriteToComputeReadWrite
//              items
// mask sensor  the same, F                                S, M               computeWriteToComputeReadWrite
// mask near    the same, S, M                             R, tiles, boxes    computeWriteToComputeReadWrite
// mask alive   the same, F, R                             tiles, boxes       computeWriteToComputeReadWrite

namespace radar {

using gpu::bytesOf;
using gpu::Residence;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

struct MaskPush {
  uint32_t first, count, groupsX, plane;
};

std::vector<gpu::Binding> bindingList() {
  std::vector<gpu::Binding> list;
  for (const uint32_t number : {gpu::kBindPositions, gpu::kBindIndices, gpu::kBindMeshes, gpu::kBindNodes,
                                gpu::kBindTargets, gpu::kBindPlacements, gpu::kBindRefs, gpu::kBindBoxes,
                                gpu::kBindMaskScopes, gpu::kBindMaskItems, gpu::kBindStates, gpu::kBindTiles}) {
    list.push_back({number, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  }
  return list;
}

}  // namespace

MaskRecorder::MaskRecorder(const Device::Impl& device, const ResidentScene& resident)
    : device_(&device),
      resident_(resident),
      bindings_(device, bindingList(), sizeof(MaskPush)),
      drawFarthest_(pipeline("mask scene", gpu::kMaskFarthest)),
      drawSensor_(pipeline("mask sensor", gpu::kMaskSensor)),
      drawNearest_(pipeline("mask near", gpu::kMaskNearest)),
      markAlive_(pipeline("mask alive", gpu::kMaskAlive)),
      items_(device, "mask items", Residence::device, kUploaded),
      scopes_(device, "mask scopes", Residence::device, kUploaded),
      tiles_(device, "tiles", Residence::device, kUploaded) {
  tiles_.reserve(2 * sizeof(uint32_t));
}

gpu::Pipeline MaskRecorder::pipeline(const char* name, uint32_t draws) const {
  // A subgroup takes a cluster.
  const uint32_t lanes = std::clamp(device_->subgroupSize, 8u, gpu::kCluster);
  return gpu::computePipeline(*device_, bindings_.layout(), k_mask_comp, name, std::array{lanes, draws});
}

VkDeviceSize MaskRecorder::prepare(std::span<const Sides> sides) {
  itemList_.clear();
  plane_ = 0;
  for (const Sides& s : sides) {
    for (uint32_t ref = s.firstScene; ref < s.end; ++ref) {
      itemList_.push_back({s.target, ref, plane_, s.firstSensor, s.firstScene});
    }
    plane_ += gpu::kMaskPixels;
  }
  sceneItems_ = static_cast<uint32_t>(itemList_.size());
  uint32_t firstPixel = 0;
  for (const Sides& s : sides) {
    for (uint32_t ref = s.firstSensor; ref < s.firstScene; ++ref) {
      itemList_.push_back({s.target, ref, firstPixel, s.firstScene, s.end});
    }
    firstPixel += gpu::kMaskPixels;
  }
  items_.reserve(bytesOf(itemList_));
  scopes_.reserve(4 * plane_ * sizeof(uint32_t));
  tiles_.reserve(itemList_.size() * gpu::kTilesPerCluster * 2 * sizeof(uint32_t));
  return gpu::Upload::aligned(bytesOf(itemList_));
}

void MaskRecorder::upload(gpu::Upload& upload) const {
  upload.add(itemList_.data(), bytesOf(itemList_), items_);
}

// A workgroup per item, in as few rows as a device allows; the shader leaves what lies beyond.
void MaskRecorder::dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t first,
                            uint32_t count) const {
  const MaskPush push{first, count, std::min(count, 65535u), plane_};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (count + push.groupsX - 1) / push.groupsX, 1);
  gpu::computeWriteToComputeReadWrite(commands);
}

void MaskRecorder::clear(const gpu::Commands& commands) const {
  const VkDeviceSize planeBytes = plane_ * sizeof(uint32_t);
  commands->CmdFillBuffer(commands, scopes_.get(), 0, 2 * planeBytes, gpu::kNobody);
  commands->CmdFillBuffer(commands, scopes_.get(), 2 * planeBytes, 2 * planeBytes, 0);
}

void MaskRecorder::record(const gpu::Commands& commands, const Lent& lent) {
  const ResidentScene::Buffers& scene = resident_.buffers();
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {{gpu::kBindPositions, &scene.positions},
                                                             {gpu::kBindIndices, &scene.indices},
                                                             {gpu::kBindMeshes, &scene.meshes},
                                                             {gpu::kBindNodes, &scene.nodes},
                                                             {gpu::kBindTargets, &lent.targets},
                                                             {gpu::kBindPlacements, &lent.placements},
                                                             {gpu::kBindRefs, &lent.refs},
                                                             {gpu::kBindBoxes, &lent.boxes},
                                                             {gpu::kBindStates, &lent.states},
                                                             {gpu::kBindMaskItems, &items_},
                                                             {gpu::kBindMaskScopes, &scopes_},
                                                             {gpu::kBindTiles, &tiles_}};
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
  bindings_.bind(commands);
  const auto sensorItems = static_cast<uint32_t>(itemList_.size()) - sceneItems_;
  dispatch(commands, drawFarthest_, 0, sceneItems_);
  dispatch(commands, drawSensor_, sceneItems_, sensorItems);
  dispatch(commands, drawNearest_, 0, sceneItems_);
  dispatch(commands, markAlive_, sceneItems_, sensorItems);
}

}  // namespace radar
