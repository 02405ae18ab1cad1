#include "embed/moved_objects.h"

#include <algorithm>

#include "gpu/barrier.h"
#include "math/rounding.h"
#include "spirv/radar_shaders.h"

namespace radar {

using gpu::BufferDomain;

namespace {

std::string nameOf(ObjectId object) {
  return "object " + std::to_string(object);
}

gpu::Moved movedOf(ObjectId id, const Scene::Impl& scene, const ObjectTree& tree) {
  gpu::Moved moved{.object = id, .mesh = scene.objects[id].object.mesh, .mask = scene.objects[id].object.mask};
  const Box* box = scene.boundsOf(id);
  moved.leaf = box == nullptr ? tree.leafOf(id) : gpu::kNobody;
  for (int k = 0; k < 3; ++k) {
    moved.anchor[k] = box == nullptr ? 0.0f : static_cast<float>(box->middle(k));
    moved.halfExtent[k] = box == nullptr
                              ? static_cast<float>(kMostCoordinate)
                              : roundDown(std::min(box->hi[k] - moved.anchor[k], moved.anchor[k] - box->lo[k]));
  }
  return moved;
}

// The nodes whose boxes change with these leaves: marks of all nodes.
std::vector<bool> markPaths(std::span<const gpu::Moved> moved, const ObjectTree& tree) {
  std::vector<bool> marks(tree.nodes().size());
  for (const gpu::Moved& object : moved) {
    for (uint32_t n = object.leaf; n != kNone && !marks[n]; n = tree.parentOf(n)) marks[n] = true;
  }
  return marks;
}

// Appends the marked inner nodes by depth, and where each depth ends.
void listByDepth(const std::vector<bool>& marks, const ObjectTree& tree, std::vector<uint32_t>& nodes,
                 std::vector<uint32_t>& ends) {
  const auto add = [&](uint32_t n) {
    if (marks[n] && (tree.nodes()[n].link & gpu::kLinkLeaf) == 0) nodes.push_back(n);
  };
  if (!marks.empty()) add(0);
  for (size_t i = 0; i < nodes.size();) {
    const size_t end = nodes.size();
    ends.push_back(static_cast<uint32_t>(end));
    for (; i < end; ++i) {
      const uint32_t left = tree.nodes()[nodes[i]].link;
      add(left);
      add(left + 1);
    }
  }
}

}  // namespace

MovedObjectsPass::MovedObjectsPass(const Device::Impl& device, const GpuScene& resident)
    : resident_(resident),
      run_(device, {shaders::kMove, shaders::kFit, shaders::kReach}),
      upload_(device),
      moved_(device, "moved objects", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      fitNodes_(device, "nodes to fit", BufferDomain::device, VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

bool MovedObjectsPass::isListed(std::span<const MovedObjects> groups, std::span<const uint32_t> firstBytes,
                                std::span<const MeshId> meshes, const Scene::Impl& scene) const {
  // An object may have taken another's number, and its leaf.
  if (!list_ || list_->scene != scene.identity || list_->objects != scene.structureVersion ||
      list_->structure != scene.objectTree().structure() || list_->bounds != scene.boundsVersion ||
      list_->groups.size() != groups.size() || !std::ranges::equal(list_->meshes, meshes)) {
    return false;
  }
  for (size_t i = 0; i < groups.size(); ++i) {
    const Group& listed = list_->groups[i];
    if (listed.firstByte != firstBytes[i] || listed.stride != groups[i].stride || listed.layout != groups[i].layout ||
        !std::ranges::equal(listed.objects, groups[i].objects)) {
      return false;
    }
  }
  return true;
}

void MovedObjectsPass::addGroup(List& list, const MovedObjects& group, uint32_t firstByte, std::vector<bool>& isNamed,
                                const Scene::Impl& scene) const {
  list.groups.push_back({firstByte, group.stride, group.layout, {group.objects.begin(), group.objects.end()}});
  for (size_t k = 0; k < group.objects.size(); ++k) {
    const ObjectId id = group.objects[k];
    if (id >= scene.objects.size() || !scene.objects[id].used) {
      throw Error("record: geometry: " + nameOf(id) + " does not exist");
    }
    if (isNamed[id]) throw Error("record: geometry: objects: expected each at most once");
    isNamed[id] = true;
    gpu::Moved moved = movedOf(id, scene, scene.objectTree());
    moved.firstByte = static_cast<uint32_t>(firstByte + k * group.stride);
    moved.format = {group.layout.row, group.layout.column};
    list.moved.push_back(moved);
  }
}

// Adds the objects that stand, but whose meshes are deformed without bounds.
void MovedObjectsPass::addStanding(List& list, const std::vector<bool>& isNamed, const Scene::Impl& scene) const {
  if (list.meshes.empty()) return;
  std::vector<bool> isDeformed(scene.meshes.size());
  for (const MeshId mesh : list.meshes) isDeformed[mesh] = true;
  for (ObjectId id = 0; id < scene.objects.size(); ++id) {
    if (isNamed[id] || !scene.objects[id].used || !isDeformed[scene.objects[id].object.mesh]) continue;
    gpu::Moved moved = movedOf(id, scene, scene.objectTree());
    moved.firstByte = gpu::kNobody;
    list.moved.push_back(moved);
    list.overwritten->standing.push_back(id);
  }
}

void MovedObjectsPass::stage(std::span<const MovedObjects> groups, std::span<const uint32_t> firstBytes,
                             std::span<const MeshId> meshes, const Scene::Impl& scene) {
  run_.begin();
  isActive_ =
      !meshes.empty() || std::ranges::any_of(groups, [](const MovedObjects& group) { return !group.objects.empty(); });
  if (!isActive_) return;
  if (isListed(groups, firstBytes, meshes, scene)) {
    isActive_ = !list_->moved.empty();
    return;
  }
  list_.reset();
  isActive_ = isUploaded_ = false;
  const ObjectTree& tree = scene.objectTree();
  auto list = std::make_unique<List>();
  list->meshes.assign(meshes.begin(), meshes.end());
  list->scene = scene.identity;
  list->objects = scene.structureVersion;
  list->structure = tree.structure();
  list->bounds = scene.boundsVersion;
  list->overwritten = std::make_shared<GpuScene::Moved>();
  std::vector<bool> isNamed(scene.objects.size());
  for (size_t i = 0; i < groups.size(); ++i) addGroup(*list, groups[i], firstBytes[i], isNamed, scene);
  addStanding(*list, isNamed, scene);
  for (const gpu::Moved& moved : list->moved) {
    if (moved.leaf != gpu::kNobody) list->unbounded.push_back(moved.object);
  }
  std::ranges::sort(list->unbounded);
  const std::vector<bool> marks = markPaths(list->moved, tree);
  listByDepth(marks, tree, list->nodes, list->ends);
  for (ObjectId id = 0; id < isNamed.size(); ++id) {
    if (isNamed[id]) list->overwritten->objects.push_back(id);
  }
  for (uint32_t n = 0; n < marks.size(); ++n) {
    if (marks[n]) list->overwritten->nodes.push_back(n);
  }
  setAnchor(push_, tree);
  push_.count = static_cast<uint32_t>(list->moved.size());
  stageUpload(*list);
  isActive_ = !list->moved.empty();
  list_ = std::move(list);  // now that all of it is staged
}

void MovedObjectsPass::stageUpload(const List& list) {
  moved_.reserve(list.moved.size());
  fitNodes_.reserve(list.nodes.size());
  upload_.begin();
  upload_.add(list.moved.data(), gpu::bytesOf(list.moved), moved_);
  upload_.add(list.nodes.data(), gpu::bytesOf(list.nodes), fitNodes_);
}

std::span<const ObjectId> MovedObjectsPass::unbounded() const {
  return isActive_ ? std::span<const ObjectId>(list_->unbounded) : std::span<const ObjectId>();
}

void MovedObjectsPass::recordUpload(const gpu::Commands& commands) const {
  if (isActive_ && !isUploaded_) upload_.record(commands);
}

void MovedObjectsPass::recordMove(const gpu::Commands& commands, const gpu::Array<uint32_t>& words,
                                  const gpu::Array<gpu::BoundsViolation>& violation) {
  if (!isActive_) return;
  const GpuScene::Buffers& scene = resident_.buffers();
  run_(commands, shaders::kMove, gpu::groupsFor(push_.count, gpu::kHostGroup), push_,
       {{gpu::kSlotMeshes, scene.meshes},
        {gpu::kSlotObjects, scene.objects},
        {gpu::kSlotPlacements, scene.placements},
        {gpu::kSlotObjectNodes, scene.objectNodes},
        {gpu::kSlotMoved, moved_},
        {gpu::kSlotBoundsViolation, violation},
        {gpu::kSlotWords, words}});
}

void MovedObjectsPass::recordFit(const gpu::Commands& commands) {
  if (!isActive_) return;
  for (size_t depth = list_->ends.size(); depth-- > 0;) {
    const uint32_t first = depth == 0 ? 0 : list_->ends[depth - 1], count = list_->ends[depth] - first;
    run_(commands, shaders::kFit, gpu::groupsFor(count, gpu::kHostGroup), gpu::FitPush{first, count},
         {{gpu::kSlotObjectNodes, resident_.buffers().objectNodes}, {gpu::kSlotFitNodes, fitNodes_}});
    gpu::computeWriteToComputeReadWrite(commands);
  }
}

void MovedObjectsPass::recordReach(const gpu::Commands& commands, const ContactPass& search) {
  if (unbounded().empty() || search.sensorCount() == 0) return;
  run_(commands, shaders::kReach, gpu::groupsFor(search.sensorCount(), gpu::kHostGroup),
       gpu::ReachPush{search.sensorCount()},
       {{gpu::kSlotSensors, search.encoded().sensors},
        {gpu::kSlotStates, search.encoded().states},
        {gpu::kSlotObjectNodes, resident_.buffers().objectNodes}});
  gpu::computeWriteToComputeReadWrite(commands);
}

std::string MovedObjectsPass::describeViolation(ObjectId object) const {
  const bool isUnbounded = std::ranges::binary_search(unbounded(), object);
  return nameOf(object) + (isUnbounded ? ": its transform is not finite, or floats cannot hold its box"
                                       : ": its mesh's box is outside its bounds, or its transform is not finite");
}

}  // namespace radar
