#include "sweep/contact_recorder.h"

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
//                                                    refs, items, states
// bounds     nodes, placements, refs                 boxes                       computeWriteToComputeReadWrite
// pairs      targets, boxes, items                   cluster pairs, states       computeWriteToComputeReadWrite
// contact    scene, targets, placements, refs, boxes cluster pairs, states,      computeWriteToComputeReadWrite
//   (some)                                           contenders
// readback   states, contenders                      readback                    computeWriteToCopy before it,
//                                                                                copyToHost
//
// Where a search is not finished, once more; where it asks for the mask, with its passes first:
//
// upload     staging                                 items, states, mask items,  uploadToRead,
//                                                    mask scopes (emptied)       fillToComputeReadWrite
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
// Nearly every search ends in the first dispatch; one that has ended costs a dispatch next to nothing.
constexpr uint32_t kSearchDispatches = 3;

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

// Pairs that the two lists can make at most.
uint64_t allPairs(const ContactPlan& plan) {
  return uint64_t{plan.sensor.size()} * plan.scene.size();
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

ContactRecorder::ContactRecorder(const Device::Impl& device, ResidentScene& resident, bool timestamps,
                                 const ContactRoom& room)
    : device_(&device),
      resident_(resident),
      room_(room),
      upload_(device),
      submission_(device, timestamps),
      bindings_(device, bindingList(), sizeof(CountPush)),
      bounds_(gpu::computePipeline(device, bindings_.layout(), k_bounds_comp, "bounds")),
      pairs_(gpu::computePipeline(device, bindings_.layout(), k_pairs_comp, "pairs")),
      direct_(searchPipeline("contact", 0)),
      masked_(searchPipeline("contact masked", 1)),
      mask_(device, resident),
      targets_(device, "targets", Residence::device, kUploaded),
      placements_(device, "placements", Residence::device, kUploaded),
      refs_(device, "cluster refs", Residence::device, kUploaded),
      boxes_(device, "cluster boxes", Residence::device, kComputed),
      items_(device, "pair items", Residence::device, kUploaded),
      clusterPairs_(device, "cluster pairs", Residence::device, kComputed),
      states_(device, "search states", Residence::device, kComputed),
      contenders_(device, "contenders", Residence::device, kComputed),
      readback_(device, "contact readback", Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

gpu::Pipeline ContactRecorder::searchPipeline(const char* name, uint32_t masked) const {
  return gpu::computePipeline(*device_, bindings_.layout(), searchShader(*device_), name,
                              std::array{std::clamp(device_->subgroupSize, 8u, 128u), room_.run, masked});
}

void ContactRecorder::stage(std::span<const ContactPlan* const> plans, std::span<const Room> rooms,
                            const Scene::Impl& scene) {
  targetList_.clear();
  sides_.clear();
  placementList_.clear();
  refList_.clear();
  itemList_.clear();
  stateList_.clear();
  uint64_t pairs = 0;
  contenderTotal_ = 0;
  for (const Room& room : rooms) {
    const ContactPlan& plan = *plans[room.plan];
    gpu::Target target = plan.target;
    target.firstPair = static_cast<uint32_t>(pairs);
    target.pairCapacity = static_cast<uint32_t>(room.pairs);
    target.firstContender = static_cast<uint32_t>(contenderTotal_);
    target.contenderCapacity = room.contenders;
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
    stateList_.push_back({.hi = room.hi, .progress = masked ? gpu::kSearchAsksMask : gpu::kSearchUnfinished});
    pairs += room.pairs;
    contenderTotal_ += room.contenders;
  }
  targets_.reserve(bytesOf(targetList_));
  placements_.reserve(bytesOf(placementList_));
  refs_.reserve(bytesOf(refList_));
  boxes_.reserve(refList_.size() * sizeof(gpu::RefBox));
  items_.reserve(bytesOf(itemList_));
  clusterPairs_.reserve(pairs * sizeof(gpu::ClusterPair));
  states_.reserve(bytesOf(stateList_));
  contenders_.reserve(contenderTotal_ * sizeof(gpu::Contender));
  readback_.reserve(bytesOf(stateList_) + contenderTotal_ * sizeof(gpu::Contender));
  upload_.begin(resident_.prepare(scene) + Upload::aligned(bytesOf(targetList_)) +
                Upload::aligned(bytesOf(placementList_)) + Upload::aligned(bytesOf(refList_)) +
                Upload::aligned(bytesOf(itemList_)) + Upload::aligned(bytesOf(stateList_)));
  resident_.upload(scene, upload_);
  upload_.add(targetList_.data(), bytesOf(targetList_), targets_);
  upload_.add(placementList_.data(), bytesOf(placementList_), placements_);
  upload_.add(refList_.data(), bytesOf(refList_), refs_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(stateList_.data(), bytesOf(stateList_), states_);
}

void ContactRecorder::bind() {
  resident_.bindTo(bindings_);
  bindings_.setBuffer(gpu::kBindNodes, resident_.buffers().nodes);
  const std::pair<uint32_t, const gpu::Buffer*> buffers[] = {
      {gpu::kBindTargets, &targets_}, {gpu::kBindPlacements, &placements_}, {gpu::kBindRefs, &refs_},
      {gpu::kBindBoxes, &boxes_},     {gpu::kBindPairItems, &items_},       {gpu::kBindClusterPairs, &clusterPairs_},
      {gpu::kBindStates, &states_},   {gpu::kBindContenders, &contenders_}, {gpu::kBindTiles, &mask_.tiles()}};
  for (const auto& [number, buffer] : buffers) bindings_.setBuffer(number, *buffer);
}

// `groups` workgroups in as few rows as a device allows; the shader leaves what lies beyond `count`.
void ContactRecorder::dispatch(const gpu::Commands& commands, const gpu::Pipeline& pipeline, uint32_t groups,
                               uint32_t count) const {
  const CountPush push{count, std::min(groups, 65535u)};
  commands->CmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.get());
  commands->CmdPushConstants(commands, bindings_.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, sizeof(push), &push);
  commands->CmdDispatch(commands, push.groupsX, (groups + push.groupsX - 1) / push.groupsX, 1);
}

void ContactRecorder::recordPairs(const gpu::Commands& commands) {
  submission_.stage("pairs");
  const auto items = static_cast<uint32_t>(itemList_.size());
  dispatch(commands, pairs_, items, items);
  gpu::computeWriteToComputeReadWrite(commands);
}

void ContactRecorder::recordSearch(const gpu::Commands& commands, const gpu::Pipeline& pipeline) {
  const auto targets = static_cast<uint32_t>(targetList_.size());
  for (uint32_t i = 0; i < kSearchDispatches; ++i) {
    dispatch(commands, pipeline, targets, targets);
    gpu::computeWriteToComputeReadWrite(commands);
  }
}

void ContactRecorder::recordReadback(const gpu::Commands& commands) {
  gpu::computeWriteToCopy(commands);
  submission_.stage("readback");
  const VkDeviceSize stateBytes = bytesOf(stateList_);
  const VkBufferCopy stateCopy{0, 0, stateBytes};
  const VkBufferCopy contenderCopy{0, stateBytes, contenderTotal_ * sizeof(gpu::Contender)};
  commands->CmdCopyBuffer(commands, states_.get(), readback_.get(), 1, &stateCopy);
  commands->CmdCopyBuffer(commands, contenders_.get(), readback_.get(), 1, &contenderCopy);
  gpu::copyToHost(commands);
}

bool ContactRecorder::stageMasks() {
  const auto* states = reinterpret_cast<const gpu::State*>(readback_.mapped());
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
  upload_.begin(mask_.prepare(asking) + Upload::aligned(bytesOf(itemList_)) + Upload::aligned(bytesOf(stateList_)));
  mask_.upload(upload_);
  upload_.add(itemList_.data(), bytesOf(itemList_), items_);
  upload_.add(stateList_.data(), bytesOf(stateList_), states_);
  return true;
}

void ContactRecorder::finish(std::vector<StageTime>& stages) {
  const auto* states = reinterpret_cast<const gpu::State*>(readback_.mapped());
  const auto is = [&](uint32_t progress) {
    return std::any_of(states, states + stateList_.size(), [&](const gpu::State& s) { return s.progress == progress; });
  };
  uint64_t before = 0;
  while (is(gpu::kSearchUnfinished) || is(gpu::kSearchAsksMask) || is(gpu::kSearchMasked)) {
    uint64_t done = 1;
    for (uint32_t i = 0; i < stateList_.size(); ++i)
      done += uint64_t{states[i].cursor} + states[i].boxPairs + states[i].round;
    const bool asked = stageMasks();
    if (done == before && !asked) throw Error("the contact search makes no progress", VK_ERROR_UNKNOWN);
    before = done;
    const bool direct = is(gpu::kSearchUnfinished), masked = asked || is(gpu::kSearchMasked);
    if (asked) bind();
    const gpu::Commands commands = submission_.begin();
    if (asked) {
      submission_.stage("upload");
      upload_.record(commands);
      mask_.clear(commands);
      gpu::uploadToRead(commands);
      gpu::fillToComputeReadWrite(commands);
      submission_.stage("mask");
      mask_.record(commands, {targets_, placements_, refs_, boxes_, states_});
    }
    const VkDescriptorSet set = bindings_.set();
    commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, bindings_.layout(), 0, 1, &set, 0,
                                    nullptr);
    if (asked) recordPairs(commands);
    submission_.stage("contact");
    if (direct) recordSearch(commands, direct_);
    submission_.stage("contact masked");
    if (masked) recordSearch(commands, masked_);
    recordReadback(commands);
    submission_.submitAndWait();
    submission_.addTimes(stages);
  }
}

// As many as the buffers hold; the others wait.
std::vector<ContactRecorder::Room> ContactRecorder::nextGroup() {
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  const uint64_t maxPairs = limit / sizeof(gpu::ClusterPair), maxContenders = limit / sizeof(gpu::Contender);
  std::vector<Room> group, again;
  uint64_t pairs = 0, contenders = 0;
  for (const Room& room : waiting_) {
    if (room.pairs > maxPairs || room.contenders > maxContenders) {
      refused_.push_back(room.plan);
    } else if (pairs + room.pairs <= maxPairs && contenders + room.contenders <= maxContenders) {
      pairs += room.pairs;
      contenders += room.contenders;
      group.push_back(room);
    } else {
      again.push_back(room);
    }
  }
  waiting_ = std::move(again);
  return group;
}

void ContactRecorder::submitGroup(std::span<const ContactPlan* const> plans, const Scene::Impl& scene) {
  group_ = nextGroup();
  if (group_.empty()) return;
  stage(plans, group_, scene);
  bind();
  const gpu::Commands commands = submission_.begin();
  const VkDescriptorSet set = bindings_.set();
  commands->CmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_COMPUTE, bindings_.layout(), 0, 1, &set, 0, nullptr);
  submission_.stage("upload");
  upload_.record(commands);
  gpu::uploadToRead(commands);
  submission_.stage("bounds");
  const auto refs = static_cast<uint32_t>(refList_.size());
  dispatch(commands, bounds_, (refs + 63) / 64, refs);
  gpu::computeWriteToComputeReadWrite(commands);
  recordPairs(commands);
  submission_.stage("contact");
  recordSearch(commands, direct_);
  recordReadback(commands);
  submission_.submit();
}

void ContactRecorder::submit(std::span<const ContactPlan* const> plans, const Scene::Impl& scene) {
  refused_.clear();
  waiting_.clear();
  for (size_t i = 0; i < plans.size(); ++i) {
    const uint64_t clusters = plans[i]->sensor.size() + plans[i]->scene.size();
    const uint64_t pairs = std::min(allPairs(*plans[i]), std::max(room_.pairs, room_.pairsPerCluster * clusters));
    waiting_.push_back({i, pairs, room_.contenders, plans[i]->hi});
  }
  submitGroup(plans, scene);
}

std::vector<size_t> ContactRecorder::collect(std::span<const ContactPlan* const> plans, const Scene::Impl& scene,
                                             std::vector<StageTime>& stages,
                                             const std::function<void(size_t, const Search&)>& found) {
  for (; !group_.empty(); submitGroup(plans, scene)) {
    submission_.wait();
    resident_.confirm(scene);
    submission_.addTimes(stages);
    finish(stages);

    // What outgrew its room goes again, with the room it is known to need.
    const auto* states = reinterpret_cast<const gpu::State*>(readback_.mapped());
    const auto* lists = reinterpret_cast<const gpu::Contender*>(readback_.mapped() + bytesOf(stateList_));
    for (uint32_t i = 0; i < group_.size(); ++i) {
      const Room& room = group_[i];
      if (states[i].pairCount > room.pairs || states[i].progress == gpu::kSearchOverflow) {
        // What a search has certainly met bounds the next one, which then keeps few contenders.
        const bool bounded = states[i].hi < room.hi;
        const bool overflow = states[i].pairCount <= room.pairs && !bounded;
        waiting_.push_back({room.plan, std::max<uint64_t>(room.pairs, states[i].pairCount),
                            overflow ? 8 * room.contenders : room.contenders, std::min(states[i].hi, room.hi)});
      } else {
        found(room.plan, {states[i], {lists + targetList_[i].firstContender, states[i].contenderCount}});
      }
    }
  }
  return std::move(refused_);
}

}  // namespace radar
