#include "sweep/bounded_recorder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iterator>
#include <limits>

#include "gpu/barrier.h"
#include "spirv/outer_draw_comp.h"
#include "spirv/outer_fill_comp.h"
#include "spirv/outer_identify_comp.h"
#include "spirv/outer_reduce_comp.h"

// pass          reads                                     writes                       barrier behind it
// ------------- ----------------------------------------- ---------------------------- ------------------------------
// upload        staging                                   scene, views, draws, items,  uploadToRead,
//                                                         bands, strips, scopes        transferToComputeReadWrite
//                                                         (emptied)
// outer scene   scene, bands, strips                      F                            computeWriteToComputeReadWrite
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
  for (uint32_t i = 0; i < gpu::kBoundedBindings; ++i) list.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
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
      drawFarthest_(drawPipelines("outer scene", gpu::kDrawFarthest)),
      drawSensor_(drawPipelines("outer sensor", gpu::kDrawSensor)),
      drawNearest_(drawPipelines("outer near", gpu::kDrawNearest)),
      reduce_(gpu::computePipeline(device, bindings_.layout(), k_outer_reduce_comp, "bound")),
      identify_(gpu::computePipeline(device, bindings_.layout(), k_outer_identify_comp, "outer identify",
                                     std::array{lanesOf(device)})),
      solve_(gpu::computePipeline(device, bindings_.layout(), solveShader(device), "solve")),
      views_(device, "outer views", Residence::device, kUploaded),
      draws_(device, "outer draws", Residence::device, kUploaded),
      items_(device, "outer items", Residence::device, kUploaded),
      bands_(device, "bands", Residence::device, kUploaded),
      strips_(device, "strips", Residence::device, kUploaded),
      scopes_(device, "outer scopes", Residence::device, kComputed | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      candidates_(device, "outer candidates", Residence::device, kComputed),
      ranks_(device, "outer ranks", Residence::device, kComputed),
      answers_(device, "outer answers", Residence::device, kComputed),
      openPairs_(device, "outer open pairs", Residence::device, kComputed),
      readback_(device, "outer readback", Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

BoundedRecorder::DrawPipelines BoundedRecorder::drawPipelines(const char* name, uint32_t draws) const {
  const std::array constants{lanesOf(*device_), draws};
  return {gpu::computePipeline(*device_, bindings_.layout(), k_outer_draw_comp, name, constants),
          gpu::computePipeline(*device_, bindings_.layout(), k_outer_fill_comp, name, constants)};
}

// Lists all bands of one side, those drawn by triangle first, and the strips of the others.
BoundedRecorder::Side BoundedRecorder::listSide(std::span<const BoundedPlan* const> plans, bool isSensor) {
  Side side{};
  side.firstBand = static_cast<uint32_t>(bandList_.size());
  side.firstStrip = static_cast<uint32_t>(stripList_.size());
  for (const bool byPixel : {false, true}) {
    uint32_t firstItem = 0;
    for (uint32_t view = 0; view < plans.size(); ++view) {
      const BoundedPlan& plan = *plans[view];
      const uint32_t rows = isSensor ? plan.sensorStrip : plan.sceneStrip;
      if ((rows > 0) == byPixel) listView(plan, isSensor ? plan.sensorBands : plan.sceneBands, view, firstItem, rows);
      firstItem += static_cast<uint32_t>(plan.items.size());
    }
    if (!byPixel) side.bands = static_cast<uint32_t>(bandList_.size()) - side.firstBand;
  }
  side.strips = static_cast<uint32_t>(stripList_.size()) - side.firstStrip;
  return side;
}

void BoundedRecorder::listView(const BoundedPlan& plan, std::span<const gpu::Band> bands, uint32_t view,
                               uint32_t firstItem, uint32_t stripRows) {
  const auto firstBand = static_cast<uint32_t>(bandList_.size());
  for (gpu::Band band : bands) {
    const gpu::Item& item = plan.items[band.item];
    const gpu::MeshRecord& mesh = resident_.record(plan.draws[item.draw].mesh);
    band.view = view;
    band.firstPixel = viewList_[view].firstPixel;
    band.pitch = plan.pitch();
    band.firstVertex = mesh.firstVertex;
    band.firstIndex = mesh.firstIndex + 3 * item.firstTriangle;
    band.item += firstItem;
    bandList_.push_back(band);
  }
  if (stripRows == 0) return;
  for (uint32_t row = 0; row < plan.view.height; row += stripRows) {
    stripList_.push_back(
        {row, std::min(row + stripRows, plan.view.height), firstBand, static_cast<uint32_t>(bandList_.size())});
  }
}

void BoundedRecorder::stage(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene) {
  viewList_.clear();
  drawList_.clear();
  itemList_.clear();
  bandList_.clear();
  stripList_.clear();
  const VkDeviceSize sceneBytes = resident_.prepare(scene);
  plane_ = 0;
  for (const BoundedPlan* plan : plans) {
    const auto firstDraw = static_cast<uint32_t>(drawList_.size());
    viewList_.push_back(plan->view);
    viewList_.back().firstPixel = plane_;
    plane_ += static_cast<uint32_t>(plan->pixels());
    drawList_.insert(drawList_.end(), plan->draws.begin(), plan->draws.end());
    for (const gpu::Item& item : plan->items) {
      itemList_.push_back({item.draw + firstDraw, item.firstTriangle, item.endTriangle});
    }
  }
  scene_ = listSide(plans, false);
  sensor_ = listSide(plans, true);

  views_.reserve(bytesOf(viewList_));
  draws_.reserve(bytesOf(drawList_));
  items_.reserve(bytesOf(itemList_));
  bands_.reserve(bytesOf(bandList_));
  strips_.reserve(std::max<VkDeviceSize>(bytesOf(stripList_), sizeof(gpu::Strip)));
  scopes_.reserve(scopeBytes(plane_));
  const VkDeviceSize cells = viewList_.size() * gpu::kCells;
  candidates_.reserve(cells * sizeof(gpu::Candidate));
  ranks_.reserve(cells * sizeof(uint32_t));
  answers_.reserve(viewList_.size() * sizeof(gpu::Answer));
  openPairs_.reserve(viewList_.size() * gpu::kOpenPairs * sizeof(gpu::OpenPair));
  upload_.begin(sceneBytes + Upload::aligned(bytesOf(viewList_)) + Upload::aligned(bytesOf(drawList_)) +
                Upload::aligned(bytesOf(itemList_)) + Upload::aligned(bytesOf(bandList_)) +
                Upload::aligned(bytesOf(stripList_)));
  resident_.upload(scene, upload_);
  upload_.add(viewList_.data(), bytesOf(viewList_), views_);
  upload_.add(drawList_.data(), bytesOf(drawList_), draws_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(bandList_.data(), bytesOf(bandList_), bands_);
  upload_.add(stripList_.data(), bytesOf(stripList_), strips_);
}

void BoundedRecorder::bind() {
  resident_.bindTo(bindings_);
  bindings_.setBuffer(gpu::kBindTriangleIds, resident_.buffers().triangleIds);
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {
      {gpu::kBindViews, &views_},  {gpu::kBindDraws, &draws_},     {gpu::kBindItems, &items_},
      {gpu::kBindBands, &bands_},  {gpu::kBindScopes, &scopes_},   {gpu::kBindCandidates, &candidates_},
      {gpu::kBindRanks, &ranks_},  {gpu::kBindAnswers, &answers_}, {gpu::kBindOpenPairs, &openPairs_},
      {gpu::kBindStrips, &strips_}};
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
}

// A workgroup per band or strip, in as few rows as a device allows; the shader leaves what lies beyond.
void BoundedRecorder::dispatchEach(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t first,
                                   uint32_t count) const {
  if (count == 0) return;
  const OuterPush push{first, count, std::min(count, 65535u), plane_};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (count + push.groupsX - 1) / push.groupsX, 1);
  gpu::computeWriteToComputeReadWrite(commands);
}

void BoundedRecorder::draw(const gpu::Commands& commands, const DrawPipelines& pipelines, const Side& side) const {
  dispatchEach(commands, pipelines.byTriangle, side.firstBand, side.bands);
  dispatchEach(commands, pipelines.byPixel, side.firstStrip, side.strips);
}

std::vector<StoredOuterScopes> BoundedRecorder::scopesOf(std::span<const BoundedPlan* const> plans,
                                                         const std::byte* stored) const {
  const auto* keys = reinterpret_cast<const uint32_t*>(stored);
  std::vector<StoredOuterScopes> scopes(plans.size());
  for (size_t i = 0; i < plans.size(); ++i) {
    std::vector<float>* planes[] = {&scopes[i].sensorNearest, &scopes[i].sceneNearest, &scopes[i].sceneFarthest,
                                    &scopes[i].sensorFarthest};
    for (size_t k = 0; k < 4; ++k) {
      const uint32_t* at = keys + k * plane_ + viewList_[i].firstPixel;
      const uint32_t none = k < 2 ? gpu::kNobody : 0;
      for (uint32_t y = 0; y < plans[i]->view.height; ++y, at += plans[i]->pitch()) {
        std::transform(at, at + plans[i]->view.width, std::back_inserter(*planes[k]), [&](uint32_t key) {
          return key == none ? std::numeric_limits<float>::quiet_NaN() : depthOf(key);
        });
      }
    }
  }
  return scopes;
}

Answers BoundedRecorder::submit(std::span<const BoundedPlan* const> plans, const Scene::Impl& scene,
                                std::vector<StageTime>& stages, std::vector<StoredOuterScopes>* scopes) {
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
  gpu::transferToComputeReadWrite(commands);

  bindings_.bind(commands);
  submission_.stage("outer scene");
  draw(commands, drawFarthest_, scene_);
  submission_.stage("outer sensor");
  draw(commands, drawSensor_, sensor_);
  submission_.stage("outer near");
  draw(commands, drawNearest_, scene_);
  submission_.stage("bound");
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, reduce_.get());
  commands->CmdDispatch(commands, views, 1, 1);
  gpu::computeWriteToComputeReadWrite(commands);
  submission_.stage("identify");
  dispatchEach(commands, identify_, 0, static_cast<uint32_t>(bandList_.size()));
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
