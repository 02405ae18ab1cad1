#include "sweep/bounded_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

#include "gpu/barrier.h"
#include "spirv/outer_draw_comp.h"
#include "spirv/outer_identify_comp.h"
#include "spirv/outer_reduce_comp.h"

// pass          reads                                     writes                       barrier behind it
// ------------- ----------------------------------------- ---------------------------- ------------------------------
// upload        staging                                   scene, views, draws, items,  uploadToRead,
//                                                         bands, scopes (emptied)      fillToComputeReadWrite
// outer scene   scene, views, draws, items, bands         F                            computeWriteToComputeReadWrite
// outer sensor  the same, F                               S, M                         computeWriteToComputeReadWrite
// outer near    the same, S                               R                            computeWriteToComputeReadWrite
// bound         views, R, M                               candidates, ranks, answers   computeWriteToComputeReadWrite
// identify      scene, views, draws, items, bands, ranks  candidates                   computeWriteToComputeReadWrite
// solve         scene, views, draws, items, candidates    answers, open pairs          computeWriteToCopy
// readback      answers, open pairs (scopes)              readback                     copyToHost

namespace radar {

using gpu::bytesOf;
using gpu::Residence;
using gpu::Upload;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkBufferUsageFlags kComputed = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

struct OuterPush {
  uint32_t first, count, groupsX, plane;
};

std::vector<gpu::Binding> bindingList() {
  std::vector<gpu::Binding> list;
  for (uint32_t i = 0; i < gpu::kBindings; ++i) list.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  return list;
}

// A subgroup takes a band, some triangles an invocation: what they share is loaded once.
uint32_t lanesOf(const Device::Impl& device) {
  return std::clamp(device.subgroupSize, 8u, gpu::kCluster);
}

// What outer.glsl makes of a depth, undone.
float depthOf(uint32_t key) {
  const uint32_t bits = (key & 0x80000000u) != 0 ? key ^ 0x80000000u : ~key;
  float depth;
  std::memcpy(&depth, &bits, sizeof(depth));
  return depth;
}

}  // namespace

BoundedRecorder::BoundedRecorder(const Device::Impl& device, ResidentScene& resident, bool timestamps)
    : device_(&device),
      resident_(resident),
      upload_(device),
      submission_(device, timestamps),
      bindings_(device, bindingList(), sizeof(OuterPush)),
      drawFarthest_(drawPipeline("outer scene", gpu::kDrawFarthest)),
      drawSensor_(drawPipeline("outer sensor", gpu::kDrawSensor)),
      drawNearest_(drawPipeline("outer near", gpu::kDrawNearest)),
      reduce_(gpu::computePipeline(device, bindings_.layout(), k_outer_reduce_comp, "bound")),
      identify_(gpu::computePipeline(device, bindings_.layout(), k_outer_identify_comp, "outer identify",
                                     std::array{lanesOf(device)})),
      solve_(gpu::computePipeline(device, bindings_.layout(), solveShader(device), "solve")),
      views_(device, "outer views", Residence::device, kUploaded),
      draws_(device, "outer draws", Residence::device, kUploaded),
      items_(device, "outer items", Residence::device, kUploaded),
      bands_(device, "bands", Residence::device, kUploaded),
      scopes_(device, "outer scopes", Residence::device, kComputed | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      candidates_(device, "outer candidates", Residence::device, kComputed),
      ranks_(device, "outer ranks", Residence::device, kComputed),
      answers_(device, "outer answers", Residence::device, kComputed),
      openPairs_(device, "outer open pairs", Residence::device, kComputed),
      readback_(device, "outer readback", Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

gpu::Pipeline BoundedRecorder::drawPipeline(const char* name, uint32_t draws) const {
  return gpu::computePipeline(*device_, bindings_.layout(), k_outer_draw_comp, name,
                              std::array{lanesOf(*device_), draws});
}

void BoundedRecorder::stage(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene) {
  viewList_.clear();
  drawList_.clear();
  itemList_.clear();
  bandList_.clear();
  const VkDeviceSize sceneBytes = resident_.prepare(scene);
  plane_ = 0;
  std::vector<gpu::Band> sensorBands;
  for (const BoundedPlan* plan : plans) {
    const auto view = static_cast<uint32_t>(viewList_.size()), firstDraw = static_cast<uint32_t>(drawList_.size()),
               firstItem = static_cast<uint32_t>(itemList_.size());
    viewList_.push_back(plan->view);
    viewList_.back().firstPixel = plane_;
    plane_ += static_cast<uint32_t>(plan->pixels());
    drawList_.insert(drawList_.end(), plan->draws.begin(), plan->draws.end());
    for (const gpu::Item& item : plan->items) {
      itemList_.push_back({item.draw + firstDraw, item.firstTriangle, item.endTriangle});
    }
    const auto add = [&](const std::vector<gpu::Band>& bands, std::vector<gpu::Band>& to) {
      for (gpu::Band band : bands) {
        const gpu::Item& item = plan->items[band.item];
        const gpu::MeshRecord& mesh = resident_.record(plan->draws[item.draw].mesh);
        band.view = view;
        band.firstPixel = viewList_.back().firstPixel;
        band.width = plan->view.width;
        band.firstVertex = mesh.firstVertex;
        band.firstIndex = mesh.firstIndex + 3 * item.firstTriangle;
        band.item += firstItem;
        to.push_back(band);
      }
    };
    add(plan->sceneBands, bandList_);
    add(plan->sensorBands, sensorBands);
  }
  sceneBands_ = static_cast<uint32_t>(bandList_.size());
  bandList_.insert(bandList_.end(), sensorBands.begin(), sensorBands.end());

  views_.reserve(bytesOf(viewList_));
  draws_.reserve(bytesOf(drawList_));
  items_.reserve(bytesOf(itemList_));
  bands_.reserve(bytesOf(bandList_));
  scopes_.reserve(scopeBytes(plane_));
  const VkDeviceSize cells = viewList_.size() * gpu::kCells;
  candidates_.reserve(cells * sizeof(gpu::Candidate));
  ranks_.reserve(cells * sizeof(uint32_t));
  answers_.reserve(viewList_.size() * sizeof(gpu::Answer));
  openPairs_.reserve(viewList_.size() * gpu::kOpenPairs * sizeof(gpu::OpenPair));
  upload_.begin(sceneBytes + Upload::aligned(bytesOf(viewList_)) + Upload::aligned(bytesOf(drawList_)) +
                Upload::aligned(bytesOf(itemList_)) + Upload::aligned(bytesOf(bandList_)));
  resident_.upload(scene, upload_);
  upload_.add(viewList_.data(), bytesOf(viewList_), views_);
  upload_.add(drawList_.data(), bytesOf(drawList_), draws_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(bandList_.data(), bytesOf(bandList_), bands_);
}

void BoundedRecorder::bind() {
  resident_.bindTo(bindings_);
  bindings_.setBuffer(gpu::kBindTriangleIds, resident_.buffers().triangleIds);
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {
      {gpu::kBindViews, &views_}, {gpu::kBindDraws, &draws_},     {gpu::kBindItems, &items_},
      {gpu::kBindBands, &bands_}, {gpu::kBindScopes, &scopes_},   {gpu::kBindCandidates, &candidates_},
      {gpu::kBindRanks, &ranks_}, {gpu::kBindAnswers, &answers_}, {gpu::kBindOpenPairs, &openPairs_}};
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
}

// A workgroup per band, in as few rows as a device allows; the shader leaves what lies beyond.
void BoundedRecorder::dispatchBands(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t first,
                                    uint32_t count) const {
  const OuterPush push{first, count, std::min(count, 65535u), plane_};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (count + push.groupsX - 1) / push.groupsX, 1);
  gpu::computeWriteToComputeReadWrite(commands);
}

std::vector<OuterScopes> BoundedRecorder::scopesOf(std::span<const BoundedPlan* const> plans,
                                                   const std::byte* stored) const {
  const auto* keys = reinterpret_cast<const uint32_t*>(stored);
  std::vector<OuterScopes> scopes(plans.size());
  for (size_t i = 0; i < plans.size(); ++i) {
    std::vector<float>* planes[] = {&scopes[i].sensorNearest, &scopes[i].sceneNearest, &scopes[i].sceneFarthest,
                                    &scopes[i].sensorFarthest};
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t* at = keys + k * plane_ + viewList_[i].firstPixel;
      const uint32_t none = k < 2 ? gpu::kNobody : 0;
      for (const uint32_t* end = at + plans[i]->pixels(); at != end; ++at) {
        planes[k]->push_back(*at == none ? std::numeric_limits<float>::quiet_NaN() : depthOf(*at));
      }
    }
  }
  return scopes;
}

Answers BoundedRecorder::submit(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene,
                                std::vector<StageTime>& stages, std::vector<OuterScopes>* scopes) {
  stage(plans, scene);
  bind();
  const auto views = static_cast<uint32_t>(plans.size());
  const VkDeviceSize answerBytes = views * sizeof(gpu::Answer);
  const VkDeviceSize openBytes = views * gpu::kOpenPairs * sizeof(gpu::OpenPair);
  const VkDeviceSize planeBytes = plane_ * sizeof(uint32_t);
  readback_.reserve(answerBytes + openBytes + (scopes != nullptr ? 4 * planeBytes : 0));

  const gpu::Commands commands = submission_.begin();
  submission_.stage("upload");
  upload_.record(commands);
  commands->CmdFillBuffer(commands, scopes_.get(), 0, 2 * planeBytes, gpu::kNobody);
  commands->CmdFillBuffer(commands, scopes_.get(), 2 * planeBytes, 2 * planeBytes, 0);
  gpu::uploadToRead(commands);
  gpu::fillToComputeReadWrite(commands);

  const VkDescriptorSet set = bindings_.set();
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, bindings_.layout(), 0, 1, &set, 0, nullptr);
  const auto bands = static_cast<uint32_t>(bandList_.size());
  submission_.stage("outer scene");
  dispatchBands(commands, drawFarthest_, 0, sceneBands_);
  submission_.stage("outer sensor");
  dispatchBands(commands, drawSensor_, sceneBands_, bands - sceneBands_);
  submission_.stage("outer near");
  dispatchBands(commands, drawNearest_, 0, sceneBands_);
  submission_.stage("bound");
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, reduce_.get());
  commands->CmdDispatch(commands, views, 1, 1);
  gpu::computeWriteToComputeReadWrite(commands);
  submission_.stage("identify");
  dispatchBands(commands, identify_, 0, bands);
  submission_.stage("solve");
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, solve_.get());
  commands->CmdDispatch(commands, views, 1, 1);
  gpu::computeWriteToCopy(commands);

  submission_.stage("readback");
  const VkBufferCopy answerCopy{0, 0, answerBytes}, openCopy{0, answerBytes, openBytes};
  commands->CmdCopyBuffer(commands, answers_.get(), readback_.get(), 1, &answerCopy);
  commands->CmdCopyBuffer(commands, openPairs_.get(), readback_.get(), 1, &openCopy);
  if (scopes != nullptr) {
    const VkBufferCopy copy{0, answerBytes + openBytes, 4 * planeBytes};
    commands->CmdCopyBuffer(commands, scopes_.get(), readback_.get(), 1, &copy);
  }
  gpu::copyToHost(commands);
  submission_.submitAndWait();
  resident_.confirm(scene);
  submission_.addTimes(stages);
  if (scopes != nullptr) *scopes = scopesOf(plans, readback_.mapped() + answerBytes + openBytes);
  return {{reinterpret_cast<const gpu::Answer*>(readback_.mapped()), views},
          {reinterpret_cast<const gpu::OpenPair*>(readback_.mapped() + answerBytes), views * gpu::kOpenPairs}};
}

}  // namespace radar
