#include "scene/gpu_scene.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

#include "gpu/api.h"
#include "gpu/barrier.h"
#include "scene/parallel.h"
#include "scene/placement.h"

namespace radar {

using gpu::BufferDomain;
using gpu::Upload;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
// Objects that a thread encodes at a time.
constexpr size_t kChunk = 4096;
constexpr VkBufferUsageFlags kTexels = kUploaded | gpu::kAsTexels;

// maxStorageBufferRange limits storage buffers; texel buffers have a limit of their own (gpu::Buffer).
template <class T>
void checkLimit(const Device::Impl& device, const char* what, uint64_t count) {
  const uint64_t bytes = count * sizeof(T), limit = device.properties.limits.maxStorageBufferRange;
  if (bytes <= limit) return;
  throw gpu::LimitError(std::string("the scene's ") + what + " need a buffer of " + std::to_string(bytes) +
                        " bytes, the device allows " + std::to_string(limit));
}

void copyPoint(const Vector& from, float (&to)[3]) {
  for (int k = 0; k < 3; ++k) to[k] = static_cast<float>(from[k]);
}

const GpuScene::Moved kNothingMoved;

const GpuScene::Moved& movedOf(const GpuScene::Overwritten& overwritten) {
  return overwritten.moved ? *overwritten.moved : kNothingMoved;
}

// Appends the elements of `all` that are not in `less`; both ascend.
template <class Id>
void addDifference(const std::vector<Id>& all, const std::vector<Id>& less, std::vector<Id>& out) {
  std::set_difference(all.begin(), all.end(), less.begin(), less.end(), std::back_inserter(out));
}

// Of the tree over objects, with those that are built behind.
size_t objectNodesOf(const ObjectTree& tree, const GpuScene::Overwritten& next) {
  return tree.nodes().size() + movedOf(next).built;
}

// Numbers of elements, of all meshes together.
struct Elements {
  uint64_t vertices = 0, triangles = 0, nodes = 0;
};
Elements elementsOf(const Scene::Impl& scene) {
  Elements all;
  for (const Mesh& mesh : scene.meshes) {
    all.vertices += mesh.vertexCount();
    all.triangles += mesh.triangleCount();
    all.nodes += mesh.tree.nodes.size();
  }
  return all;
}

}  // namespace

GpuScene::Buffers::Buffers(const gpu::Owner& owner)
    : vertices(owner, "vertices", BufferDomain::device, kTexels | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      triangles(owner, "triangles", BufferDomain::device, kTexels),
      meshNodes(owner, "mesh nodes", BufferDomain::device, kTexels),
      meshes(owner, "meshes", BufferDomain::device, kUploaded),
      objects(owner, "objects", BufferDomain::device, kUploaded),
      placements(owner, "placements", BufferDomain::device, kTexels),
      objectNodes(owner, "object nodes", BufferDomain::device, kTexels),
      indices(owner, "indices", BufferDomain::device, kUploaded | VK_BUFFER_USAGE_INDEX_BUFFER_BIT) {}

GpuScene::GpuScene(const Device::Impl& device)
    : owner_(gpu::Owner::counted(device)),
      buffers_(std::make_shared<Buffers>(owner_)),
      farthest_(std::make_shared<const std::vector<Vector>>()) {}

// Whether no buffer that searches use need grow.
bool GpuScene::fits(const Scene::Impl& scene, const Overwritten& next) const {
  const auto [vertices, triangles, nodes] = elementsOf(scene);
  const uint64_t objects = scene.objects.size();
  return vertices <= buffers_->vertices.capacity() && triangles <= buffers_->triangles.capacity() &&
         nodes <= buffers_->meshNodes.capacity() && scene.meshes.size() <= buffers_->meshes.capacity() &&
         objects <= std::min(buffers_->objects.capacity(), buffers_->placements.capacity()) &&
         objectNodesOf(scene.objectTree(), next) <= buffers_->objectNodes.capacity();
}

void GpuScene::forget() {
  ++era_;
  seen_ = {};
  for (Place& place : places_) place.uploaded = place.uploadedIndices = 0;
}

void GpuScene::clear() {
  for (Arena* arena : {&vertices_, &triangles_, &nodes_}) arena->reset(0);
  places_.clear();
  forget();
}

GpuScene::Staged GpuScene::stage(const Scene::Impl& scene, Overwritten next, Upload& upload) try {
  std::ranges::sort(next.meshes);
  if (seen_.scene != scene.identity) forget();
  checkWriteLimits(scene, next);
  if (buffers_.use_count() > 1 && !fits(scene, next)) {
    buffers_ = std::make_shared<Buffers>(owner_);
    clear();
  }
  const ObjectTree& tree = scene.objectTree();
  Staged staged{.era = era_,
                .seen = {scene.identity, scene.meshVersion, scene.poseVersion, tree.version(), std::move(next)}};
  stageMeshes(scene, staged, upload);
  stageIndices(scene, staged, upload);
  stageObjects(scene, staged.seen.overwritten, upload);
  stageTree(tree, staged.seen.overwritten, upload);
  return staged;
} catch (...) {
  // Some buffers may have grown, and lost their contents: everything is placed and staged again.
  clear();
  throw;
}

void GpuScene::commit(Staged staged) noexcept {
  if (staged.era != era_) return;
  seen_ = std::move(staged.seen);
  for (const auto& [mesh, version] : staged.meshes) places_[mesh].uploaded = version;
  for (const auto& [mesh, version] : staged.indices) places_[mesh].uploadedIndices = version;
}

void GpuScene::removePlace(MeshId id) {
  vertices_.free(records_[id].firstVertex, places_[id].vertices);
  triangles_.free(records_[id].firstTriangle, places_[id].triangles);
  nodes_.free(records_[id].firstNode, places_[id].nodes);
  places_[id] = {};
}

// Finds ranges for a mesh; returns false if the buffers are full.
bool GpuScene::placeMesh(MeshId id, const Mesh& mesh) {
  const std::optional<uint64_t> vertex = vertices_.allocate(mesh.vertexCount()),
                                triangle = triangles_.allocate(mesh.triangleCount()),
                                node = nodes_.allocate(mesh.tree.nodes.size());
  if (!vertex || !triangle || !node) return false;
  places_[id] = {mesh.vertexCount(), mesh.triangleCount(), mesh.tree.nodes.size()};
  records_[id].firstVertex = static_cast<uint32_t>(*vertex);
  records_[id].firstTriangle = static_cast<uint32_t>(*triangle);
  records_[id].firstNode = static_cast<uint32_t>(*node);
  return true;
}

// Places all meshes anew, in larger buffers if need be.
void GpuScene::layOut(const Scene::Impl& scene) {
  const auto [vertices, triangles, nodes] = elementsOf(scene);
  if (vertices > gpu::kLinkItem || triangles > gpu::kLinkItem || nodes > gpu::kLinkItem) {
    throw gpu::LimitError("the scene's meshes exceed 2^30 vertices, triangles or nodes");
  }
  places_.assign(scene.meshes.size(), {});
  seen_.poses = 0;  // placements refer to nodes
  buffers_->vertices.reserve(vertices);
  buffers_->triangles.reserve(triangles);
  buffers_->meshNodes.reserve(nodes);
  vertices_.reset(std::min<uint64_t>(buffers_->vertices.capacity(), gpu::kLinkItem));
  triangles_.reset(std::min<uint64_t>(buffers_->triangles.capacity(), gpu::kLinkItem));
  nodes_.reset(std::min<uint64_t>(buffers_->meshNodes.capacity(), gpu::kLinkItem));
  for (MeshId id = 0; id < scene.meshes.size(); ++id) placeMesh(id, scene.meshes[id]);
}

// Keeps the places of meshes that have the same numbers of elements as before.
void GpuScene::placeMeshes(const Scene::Impl& scene, const Overwritten& next) {
  const auto numbersOf = [](const Mesh& mesh) {
    return std::array<uint64_t, 3>{mesh.vertexCount(), mesh.triangleCount(), mesh.tree.nodes.size()};
  };
  std::vector<MeshId> homeless;
  for (MeshId id = 0; id < places_.size(); ++id) {
    const Place& place = places_[id];
    const std::array<uint64_t, 3> now =
        id < scene.meshes.size() ? numbersOf(scene.meshes[id]) : std::array<uint64_t, 3>{};
    if (now == std::array{place.vertices, place.triangles, place.nodes}) continue;
    removePlace(id);
    if (now[1] > 0) homeless.push_back(id);
  }
  for (auto id = static_cast<MeshId>(places_.size()); id < scene.meshes.size(); ++id) homeless.push_back(id);
  places_.resize(scene.meshes.size());
  records_.resize(scene.meshes.size());
  const bool fits = std::ranges::all_of(homeless, [&](MeshId id) { return placeMesh(id, scene.meshes[id]); });
  if (!fits || exceedsWriteLimits(next)) layOut(scene);
}

// Whether meshes that the host overwrites may end beyond what a storage buffer binds.
bool GpuScene::exceedsWriteLimits(const Overwritten& next) const {
  if (next.meshes.empty()) return false;
  const uint64_t limit = owner_.device().properties.limits.maxStorageBufferRange;
  for (MeshId id = 0; id < places_.size(); ++id) {
    if ((records_[id].firstVertex + places_[id].vertices) * sizeof(gpu::Vertex) > limit ||
        (records_[id].firstNode + places_[id].nodes) * sizeof(gpu::MeshNode) > limit) {
      return true;
    }
  }
  return false;
}

// Buffers that shaders write are bound as storage buffers, so they are subject to maxStorageBufferRange.
void GpuScene::checkWriteLimits(const Scene::Impl& scene, const Overwritten& next) const {
  const Moved& moved = movedOf(next);
  if (!moved.objects.empty() || !moved.standing.empty())
    checkLimit<gpu::Placement>(owner_, "placements", scene.objects.size());
  if (!moved.nodes.empty()) {
    checkLimit<gpu::ObjectNode>(owner_, "object nodes", objectNodesOf(scene.objectTree(), next));
  }
  if (next.meshes.empty()) return;
  const Elements elements = elementsOf(scene);
  checkLimit<gpu::Vertex>(owner_, "vertices", elements.vertices);
  checkLimit<gpu::MeshNode>(owner_, "mesh nodes", elements.nodes);
}

void GpuScene::describe(MeshId id, const Mesh& mesh) {
  gpu::MeshRecord& record = records_[id];
  copyPoint(mesh.origin, record.origin);
  copyPoint(mesh.box.lo, record.lo);
  copyPoint(mesh.box.hi, record.hi);
  record.unit = mesh.used ? static_cast<float>(mesh.unit) : 0.0f;
  record.perUnit = static_cast<float>(1 / mesh.unit);
}

void GpuScene::stageMesh(const Mesh& mesh, const gpu::MeshRecord& record, Upload& upload) const {
  std::vector<gpu::Vertex> vertices(mesh.vertexCount());
  for (uint32_t v = 0; v < vertices.size(); ++v) {
    std::copy_n(&mesh.positions[3 * size_t{v}], 3, vertices[v].position);
    vertices[v].number = mesh.hostVertex(v);
  }
  std::vector<gpu::Triangle> triangles;
  triangles.reserve(mesh.triangleCount());
  for (const uint32_t id : mesh.tree.order) {
    const uint32_t* corner = &mesh.indices[3 * size_t{id}];
    triangles.push_back(
        {{record.firstVertex + corner[0], record.firstVertex + corner[1], record.firstVertex + corner[2]}, id});
  }
  NodeVector<gpu::MeshNode> nodes = mesh.tree.nodes;
  for (gpu::MeshNode& node : nodes) {
    node.link += (node.link & gpu::kLinkLeaf) != 0 ? record.firstTriangle : record.firstNode;
  }
  upload.add(vertices.data(), gpu::bytesOf(vertices), buffers_->vertices,
             sizeof(gpu::Vertex) * VkDeviceSize{record.firstVertex});
  upload.add(triangles.data(), gpu::bytesOf(triangles), buffers_->triangles,
             sizeof(gpu::Triangle) * VkDeviceSize{record.firstTriangle});
  upload.add(nodes.data(), gpu::bytesOf(nodes), buffers_->meshNodes,
             sizeof(gpu::MeshNode) * VkDeviceSize{record.firstNode});
}

void GpuScene::stageMeshes(const Scene::Impl& scene, Staged& staged, Upload& upload) {
  const Overwritten& next = staged.seen.overwritten;
  std::vector<MeshId> restored;
  addDifference(seen_.overwritten.meshes, next.meshes, restored);
  // Shaders need buffers even if there is no mesh.
  buffers_->vertices.reserve(0);
  buffers_->triangles.reserve(0);
  buffers_->meshNodes.reserve(0);
  buffers_->meshes.reserve(0);
  if (seen_.meshes == scene.meshVersion && restored.empty() && !exceedsWriteLimits(next)) return;
  for (const MeshId id : restored) places_[id].uploaded = 0;
  checkLimit<gpu::MeshRecord>(owner_, "meshes", scene.meshes.size());
  placeMeshes(scene, next);
  buffers_->meshes.reserve(records_.size());
  std::vector<Vector> farthest;
  for (const Mesh& mesh : scene.meshes) farthest.push_back(mesh.farthest);
  farthest_ = std::make_shared<const std::vector<Vector>>(std::move(farthest));
  for (MeshId id = 0; id < scene.meshes.size(); ++id) {
    const Mesh& mesh = scene.meshes[id];
    describe(id, mesh);
    if (places_[id].uploaded == mesh.version) continue;
    stageMesh(mesh, records_[id], upload);
    staged.meshes.emplace_back(id, mesh.version);
  }
  upload.add(records_.data(), gpu::bytesOf(records_), buffers_->meshes);
}

void GpuScene::stageIndices(const Scene::Impl& scene, Staged& staged, Upload& upload) {
  if (!hasIndices_) return;
  if (buffers_->indices.reserve(3 * buffers_->triangles.capacity())) {
    for (Place& place : places_) place.uploadedIndices = 0;
  }
  const uint32_t most = owner_.device().properties.limits.maxDrawIndexedIndexValue;
  for (MeshId id = 0; id < places_.size(); ++id) {
    const Mesh& mesh = scene.meshes[id];
    const gpu::MeshRecord& record = records_[id];
    if (places_[id].vertices > 0 && record.firstVertex + (places_[id].vertices - 1) > most) {
      throw gpu::LimitError("the scene's meshes have vertices beyond number " + std::to_string(most) +
                            ", the device's maxDrawIndexedIndexValue");
    }
    if (places_[id].uploadedIndices == mesh.version) continue;
    std::vector<uint32_t> indices;
    indices.reserve(mesh.indices.size());
    for (const uint32_t triangle : mesh.tree.order) {
      for (int i = 0; i < 3; ++i) indices.push_back(record.firstVertex + mesh.indices[3 * size_t{triangle} + i]);
    }
    upload.add(indices.data(), gpu::bytesOf(indices), buffers_->indices, 12 * VkDeviceSize{record.firstTriangle});
    staged.indices.emplace_back(id, mesh.version);
  }
}

// Ascending.
std::vector<ObjectId> GpuScene::changedObjects(const Scene::Impl& scene, const Overwritten& next) const {
  std::vector<ObjectId> changed, restored;
  scene.changedObjects.forEachSince(seen_.poses, [&](size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      if (scene.changedAt[i] > seen_.poses && scene.objects[i].used) changed.push_back(static_cast<ObjectId>(i));
    }
  });
  if (seen_.overwritten.moved != next.moved) {
    addDifference(movedOf(seen_.overwritten).objects, movedOf(next).objects, restored);
    addDifference(movedOf(seen_.overwritten).standing, movedOf(next).standing, restored);
  }
  for (const ObjectId id : restored) {
    if (scene.objects[id].used && scene.changedAt[id] <= seen_.poses) changed.push_back(id);
  }
  if (!restored.empty()) std::ranges::sort(changed);
  return changed;
}

void GpuScene::stageObjects(const Scene::Impl& scene, const Overwritten& next, Upload& upload) {
  checkLimit<gpu::ObjectRecord>(owner_, "objects", scene.objects.size());
  const bool grew = buffers_->objects.reserve(scene.objects.size());
  if (buffers_->placements.reserve(scene.objects.size()) || grew) seen_.poses = 0;
  const std::vector<ObjectId> changed = changedObjects(scene, next);
  if (changed.empty()) return;
  static_assert(sizeof(gpu::ObjectRecord) % 8 == 0 && sizeof(gpu::Placement) % 8 == 0);  // for Upload::reserve
  // Where each array's changed elements begin; all follow in their order.
  const auto places = [&](const gpu::Buffer& target, VkDeviceSize size) {
    std::byte* first = nullptr;
    upload.reserve(size * changed.size());
    for (size_t i = 0, end = 0; i < changed.size(); i = end) {
      for (end = i + 1; end < changed.size() && changed[end] == changed[end - 1] + 1;) ++end;
      std::byte* at = upload.place(size * (end - i), target, size * changed[i]);
      if (i == 0) first = at;
    }
    return first;
  };
  std::byte* records = places(buffers_->objects, sizeof(gpu::ObjectRecord));
  std::byte* placements = places(buffers_->placements, sizeof(gpu::Placement));
  parallelFor(changed.size(), kChunk, 0, [&](unsigned, size_t first, size_t last) {
    for (size_t i = first; i < last; ++i) {
      const Object& object = scene.objects[changed[i]].object;
      gpu::ObjectRecord record{};
      std::copy(object.worldFromMesh.m.begin(), object.worldFromMesh.m.end(), record.pose);
      record.mesh = object.mesh;
      gpu::Placement placement = placementOf(scene.meshes[object.mesh], object.worldFromMesh);
      placement.root = records_[object.mesh].firstNode;
      placement.mask = object.mask;
      placement.mesh = object.mesh;
      std::memcpy(records + i * sizeof(record), &record, sizeof(record));
      std::memcpy(placements + i * sizeof(placement), &placement, sizeof(placement));
    }
  });
}

void GpuScene::stageTree(const ObjectTree& tree, const Overwritten& next, Upload& upload) {
  const NodeVector<gpu::ObjectNode>& nodes = tree.nodes();
  if (buffers_->objectNodes.reserve(objectNodesOf(tree, next))) seen_.tree = 0;
  const auto add = [&](size_t first, size_t last) {
    const VkDeviceSize size = sizeof(gpu::ObjectNode);
    upload.add(&nodes[first], size * (last - first), buffers_->objectNodes, size * first);
  };
  std::vector<uint32_t> restored;
  if (seen_.overwritten.moved != next.moved) {
    addDifference(movedOf(seen_.overwritten).nodes, movedOf(next).nodes, restored);
  }
  if (restored.empty()) return tree.changedNodes().forEachSince(seen_.tree, add);
  ChangedPages both = tree.changedNodes();
  for (const uint32_t node : restored) {
    if (node < nodes.size()) both.mark(node, seen_.tree + 1);
  }
  both.forEachSince(seen_.tree, add);
}

void GpuScene::sync(const Scene::Impl& scene) {
  if (!sync_) sync_ = std::make_unique<Sync>(Sync{gpu::Upload(owner_), gpu::Submission(owner_, false)});
  sync_->upload.begin();
  Staged staged = stage(scene, {}, sync_->upload);
  if (sync_->upload.bytes() != 0) {
    const gpu::Commands commands = sync_->submission.begin();
    gpu::computeToOverwrite(commands);
    sync_->submission.stage("upload");
    sync_->upload.record(commands);
    gpu::transferToComputeReadWrite(commands);
    sync_->submission.submitAndWait();
  }
  commit(std::move(staged));
}

}  // namespace radar
