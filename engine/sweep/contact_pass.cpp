#include "sweep/contact_pass.h"

#include <algorithm>
#include <array>

#include "gpu/barrier.h"
#include "spirv/bounds_comp.h"
#include "spirv/contact_comp.h"
#include "spirv/contact_comp_RADAR_NO_DOUBLES.h"
#include "spirv/pairs_comp.h"

// pass       reads                                   writes                      barrier behind it
// ---------- --------------------------------------- --------------------------- ------------------------------
// upload     staging                                 scene, targets, placements, uploadToRead
//                                                    refs, items, states,
//                                                    results
// bounds     nodes, placements, refs                 boxes                       computeWriteToComputeReadWrite
// pairs      targets, boxes, items                   cluster pairs, states       computeWriteToComputeReadWrite
// contact    scene, targets, placements, refs, boxes cluster pairs, states,      computeWriteToComputeReadWrite
//   (some)                                           contenders
// tell       (tell_recorder.cpp)                     results, open               (the caller's)
//
// Where a search is not finished, once more; where it asks for the mask, with its passes first:
//
// upload     staging                                 items, states, mask items,  uploadToRead,
//                                                    mask scopes (emptied)       transferToComputeReadWrite
// mask       (mask_recorder.cpp)                     tiles, boxes
// pairs      as above
// masked     as contact, tiles                       as contact                  computeWriteToComputeReadWrite
//   (some)

namespace radar {

using gpu::bytesOf;
using gpu::Residence;
using gpu::Upload;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
constexpr VkBufferUsageFlags kComputed = kUploaded | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

struct CountPush {
  uint32_t count, groupsX;
};

std::span<const uint32_t> searchShader(const Device::Impl& device) {
  if (device.doubles) return k_contact_comp;
  return k_contact_comp_RADAR_NO_DOUBLES;
}

std::vector<gpu::Binding> bindingList() {
  std::vector<gpu::Binding> list;
  for (uint32_t i = 0; i < gpu::kContactBindings; ++i) list.push_back({i, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER});
  return list;
}

void addItems(std::vector<gpu::PairItem>& items, const MaskRecorder::Sides& s) {
  for (uint32_t a = s.firstSensor; a < s.firstScene; a += gpu::kPairItemA) {
    for (uint32_t b = s.firstScene; b < s.end; b += gpu::kPairItemB) {
      items.push_back(
          {s.target, a, std::min(a + gpu::kPairItemA, s.firstScene), b, std::min(b + gpu::kPairItemB, s.end)});
    }
  }
}

}  // namespace

uint64_t allPairs(const ContactPlan& plan) {
  return uint64_t{plan.sensor.size()} * plan.scene.size();
}

uint64_t firstPairs(const ContactPlan& plan, const ContactRoom& room) {
  const uint64_t clusters = plan.sensor.size() + plan.scene.size();
  return std::min(allPairs(plan), std::max(room.pairs, room.pairsPerCluster * clusters));
}

ContactPass::ContactPass(const Device::Impl& device, ResidentScene& resident, const ContactRoom& room)
    : device_(&device),
      resident_(resident),
      room_(room),
      upload_(device),
      bindings_(device, bindingList(), sizeof(CountPush)),
      bounds_(gpu::computePipeline(device, bindings_.layout(), k_bounds_comp, "bounds")),
      pairs_(gpu::computePipeline(device, bindings_.layout(), k_pairs_comp, "pairs")),
      direct_(searchPipeline("contact", 0)),
      tell_(device, resident, room.openContenders),
      targets_(device, "targets", Residence::device, kUploaded),
      placements_(device, "placements", Residence::device, kUploaded),
      refs_(device, "cluster refs", Residence::device, kUploaded),
      boxes_(device, "cluster boxes", Residence::device, kComputed),
      items_(device, "pair items", Residence::device, kUploaded),
      clusterPairs_(device, "cluster pairs", Residence::device, kComputed),
      states_(device, "search states", Residence::device, kComputed),
      contenders_(device, "contenders", Residence::device, kComputed) {
  if (room.way != ContactWay::direct) {
    masked_.emplace(Masked{MaskRecorder(device, resident), searchPipeline("contact masked", 1)});
  }
}

gpu::Pipeline ContactPass::searchPipeline(const char* name, uint32_t masked) const {
  return gpu::computePipeline(*device_, bindings_.layout(), searchShader(*device_), name,
                              std::array{std::clamp(device_->subgroupSize, 8u, 128u), room_.run, masked});
}

void ContactPass::reserve(const Capacity& capacity) {
  // A run of kPairItemA clusters of a sensor makes an item for each kPairItemB of the scene's.
  const VkDeviceSize half = capacity.clusters / 2;
  const VkDeviceSize items =
      (half / gpu::kPairItemA + capacity.queries) * (half / gpu::kPairItemB + 1) + capacity.clusters / gpu::kPairItemB;
  const std::pair<gpu::Buffer*, VkDeviceSize> uploaded[] = {{&targets_, capacity.queries * sizeof(gpu::Target)},
                                                            {&placements_, capacity.clusters * sizeof(gpu::Placement)},
                                                            {&refs_, capacity.clusters * sizeof(gpu::ClusterRef)},
                                                            {&items_, items * sizeof(gpu::PairItem)},
                                                            {&states_, capacity.queries * sizeof(gpu::State)}};
  reserved_ = Upload::aligned(capacity.queries * sizeof(Result));
  for (const auto& [buffer, bytes] : uploaded) {
    buffer->reserve(bytes);
    reserved_ += Upload::aligned(bytes);
  }
  boxes_.reserve(capacity.clusters * sizeof(gpu::RefBox));
  clusterPairs_.reserve(capacity.clusterPairs * sizeof(gpu::ClusterPair));
  contenders_.reserve(VkDeviceSize{capacity.queries} * capacity.contenders * sizeof(gpu::Contender));
  tell_.prepare(capacity.queries);
}

void ContactPass::stage(std::span<const Search> searches, std::span<const Result> known, const Scene::Impl& scene) {
  targetList_.clear();
  sides_.clear();
  placementList_.clear();
  refList_.clear();
  itemList_.clear();
  stateList_.clear();
  uint64_t pairs = 0, contenders = 0;
  for (const Search& search : searches) {
    const ContactPlan& plan = *search.plan;
    gpu::Target target = plan.target;
    target.firstPair = static_cast<uint32_t>(pairs);
    target.pairCapacity = static_cast<uint32_t>(search.pairs);
    target.firstContender = static_cast<uint32_t>(contenders);
    target.contenderCapacity = search.contenders;
    target.result = search.result;
    const auto firstPlacement = static_cast<uint32_t>(placementList_.size());
    const auto firstRef = static_cast<uint32_t>(refList_.size());
    for (const auto* list : {&plan.sensor, &plan.scene}) {
      for (const gpu::ClusterRef& ref : *list) refList_.push_back({ref.placement + firstPlacement, ref.node});
    }
    placementList_.insert(placementList_.end(), plan.placements.begin(), plan.placements.end());
    const auto number = static_cast<uint32_t>(targetList_.size());
    sides_.push_back({number, firstRef, firstRef + static_cast<uint32_t>(plan.sensor.size()),
                      static_cast<uint32_t>(refList_.size())});
    addItems(itemList_, sides_.back());
    const bool canMask = target.maskCost != gpu::kNoMask && sides_.back().clusters() <= MaskRecorder::kMostClusters;
    if (room_.way == ContactWay::direct || !canMask) target.maskCost = gpu::kNoMask;
    targetList_.push_back(target);
    const bool masked = room_.way == ContactWay::masked && canMask;
    stateList_.push_back({.hi = search.hi, .progress = masked ? gpu::kSearchAsksMask : gpu::kSearchUnfinished});
    pairs += search.pairs;
    contenders += search.contenders;
  }
  targets_.reserve(bytesOf(targetList_));
  placements_.reserve(bytesOf(placementList_));
  refs_.reserve(bytesOf(refList_));
  boxes_.reserve(refList_.size() * sizeof(gpu::RefBox));
  items_.reserve(bytesOf(itemList_));
  clusterPairs_.reserve(pairs * sizeof(gpu::ClusterPair));
  states_.reserve(bytesOf(stateList_));
  contenders_.reserve(contenders * sizeof(gpu::Contender));
  tell_.prepare(static_cast<uint32_t>(std::max(known.size(), targetList_.size())));
  const VkDeviceSize lists = Upload::aligned(bytesOf(targetList_)) + Upload::aligned(bytesOf(placementList_)) +
                             Upload::aligned(bytesOf(refList_)) + Upload::aligned(bytesOf(itemList_)) +
                             Upload::aligned(bytesOf(stateList_)) + Upload::aligned(known.size_bytes());
  upload_.begin(resident_.prepare(scene) + std::max(lists, reserved_));
  resident_.upload(scene, upload_);
  upload_.add(targetList_.data(), bytesOf(targetList_), targets_);
  upload_.add(placementList_.data(), bytesOf(placementList_), placements_);
  upload_.add(refList_.data(), bytesOf(refList_), refs_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(stateList_.data(), bytesOf(stateList_), states_);
  upload_.add(known.data(), known.size_bytes(), tell_.results());
  bind();
}

void ContactPass::bind() {
  resident_.bindTo(bindings_);
  bindings_.setBuffer(gpu::kBindNodes, resident_.buffers().nodes);
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {
      {gpu::kBindTargets, &targets_},
      {gpu::kBindPlacements, &placements_},
      {gpu::kBindRefs, &refs_},
      {gpu::kBindBoxes, &boxes_},
      {gpu::kBindPairItems, &items_},
      {gpu::kBindClusterPairs, &clusterPairs_},
      {gpu::kBindStates, &states_},
      {gpu::kBindContenders, &contenders_},
      {gpu::kBindTiles, masked_ ? &masked_->mask.tiles() : &states_}};  // which the direct search does not read
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
}

// `groups` workgroups in as few rows as a device allows; the shader leaves what lies beyond `count`.
void ContactPass::dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t groups,
                           uint32_t count) const {
  const CountPush push{count, std::min(groups, 65535u)};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (groups + push.groupsX - 1) / push.groupsX, 1);
}

bool ContactPass::stageMasks(const gpu::State* states) {
  std::vector<MaskRecorder::Sides> asking;
  itemList_.clear();
  uint32_t clusters = 0;
  for (uint32_t i = 0; i < stateList_.size(); ++i) {
    stateList_[i] = states[i];
    if (states[i].progress != gpu::kSearchAsksMask) continue;
    if (clusters + sides_[i].clusters() > MaskRecorder::kMostClusters) continue;  // the next time
    // What is alive is searched from the start, within what is known to be met.
    stateList_[i].progress = gpu::kSearchMasked;
    stateList_[i].pairCount = stateList_[i].contenderCount = stateList_[i].round = stateList_[i].cursor = 0;
    stateList_[i].tiles = clusters - sides_[i].firstSensor;  // modulo 2^32, as in the shader
    clusters += sides_[i].clusters();
    asking.push_back(sides_[i]);
    addItems(itemList_, sides_[i]);
  }
  if (asking.empty()) return false;
  upload_.begin(masked_->mask.prepare(asking) + Upload::aligned(bytesOf(itemList_)) +
                Upload::aligned(bytesOf(stateList_)));
  masked_->mask.upload(upload_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(stateList_.data(), bytesOf(stateList_), states_);
  bind();
  return true;
}

void ContactPass::recordPairs(const gpu::Commands& commands, const OpenStage& stage) {
  stage("pairs");
  const auto items = static_cast<uint32_t>(itemList_.size());
  dispatch(commands, pairs_, items, items);
  gpu::computeWriteToComputeReadWrite(commands);
}

void ContactPass::recordSearch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t dispatches) {
  for (uint32_t i = 0; i < dispatches; ++i) {
    dispatch(commands, pipeline, searches(), searches());
    gpu::computeWriteToComputeReadWrite(commands);
  }
}

void ContactPass::recordAnswers(const gpu::Commands& commands, const OpenStage& stage) {
  stage("tell");
  tell_.record(commands, {targets_, states_, contenders_}, searches());
}

void ContactPass::recordUpload(const gpu::Commands& commands, const OpenStage& stage) {
  stage("upload");
  upload_.record(commands);
  gpu::uploadToRead(commands);
}

void ContactPass::record(const gpu::Commands& commands, const OpenStage& stage, uint32_t dispatches) {
  if (targetList_.empty()) return;
  bindings_.bind(commands);
  stage("bounds");
  const auto refs = static_cast<uint32_t>(refList_.size());
  dispatch(commands, bounds_, (refs + 63) / 64, refs);
  gpu::computeWriteToComputeReadWrite(commands);
  recordPairs(commands, stage);
  stage("contact");
  recordSearch(commands, direct_, dispatches);
  recordAnswers(commands, stage);
}

void ContactPass::recordAgain(const gpu::Commands& commands, const OpenStage& stage, const Again& again,
                              uint32_t dispatches) {
  if (again.masks) {
    stage("upload");
    upload_.record(commands);
    masked_->mask.clear(commands);
    gpu::uploadToRead(commands);
    gpu::transferToComputeReadWrite(commands);
    stage("mask");
    masked_->mask.record(commands, {targets_, placements_, refs_, boxes_, states_});
  }
  bindings_.bind(commands);
  if (again.masks) recordPairs(commands, stage);
  stage("contact");
  if (again.direct) recordSearch(commands, direct_, dispatches);
  stage("contact masked");
  if (again.masked) recordSearch(commands, masked_->search, dispatches);
  recordAnswers(commands, stage);
}

}  // namespace radar
