#include "scene/gpu_scene.h"

#include <algorithm>
#include <iterator>

#include "gpu/barrier.h"
#include "gpu/limit_error.h"
#include "scene/placement.h"

namespace radar {

using gpu::BufferDomain;
using gpu::Upload;

namespace {

constexpr VkBufferUsageFlags kUploaded = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
// Floats are stored as integers, since a device may change the bits of subnormal floats and NaNs.
constexpr VkFormat kTexels = VK_FORMAT_R32G32B32A32_UINT;

// maxStorageBufferRange limits storage buffers; texel buffers have a limit of their own (TexelBuffer).
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

// Appends the elements of `all` that are not in `less`; both ascend.
template <class Id>
void addDifference(const std::vector<Id>& all, const std::vector<Id>& less, std::vector<Id>& out) {
  std::set_difference(all.begin(), all.end(), less.begin(), less.end(), std::back_inserter(out));
}

}  // namespace

GpuScene::GpuScene(const Device::Impl& device)
    : device_(&device),
      buffers_{{device, "vertices", BufferDomain::device, kUploaded | VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, kTexels},
               {device, "triangles", BufferDomain::device, kUploaded, kTexels},
               {device, "mesh nodes", BufferDomain::device, kUploaded, kTexels},
               {device, "meshes", BufferDomain::device, kUploaded},
               {device, "objects", BufferDomain::device, kUploaded},
               {device, "placements", BufferDomain::device, kUploaded, kTexels},
               {device, "object nodes", BufferDomain::device, kUploaded, kTexels},
               {device, "indices", BufferDomain::device, kUploaded | VK_BUFFER_USAGE_INDEX_BUFFER_BIT}} {}

void GpuScene::willOverwrite(Overwritten next) {
  next_ = std::move(next);
  std::sort(next_.meshes.begin(), next_.meshes.end());
  std::sort(next_.objects.begin(), next_.objects.end());
}

void GpuScene::forget() {
  seenScene_ = seenMeshes_ = seenIndices_ = seenPoses_ = seenTree_ = 0;
  overwritten_ = {};
}

VkDeviceSize GpuScene::prepare(const Scene::Impl& scene) {
  if (seenScene_ != scene.identity) forget();
  checkWriteLimits(scene);
  const VkDeviceSize meshes = prepareMeshes(scene);
  return meshes + prepareIndices(scene) + prepareObjects(scene);
}

// Assigns every mesh its place in the buffers.
void GpuScene::layOut(const Scene::Impl& scene) {
  records_.assign(scene.meshes.size(), {});
  farthest_.clear();
  uint64_t vertices = 0, triangles = 0, nodes = 0;
  for (MeshId i = 0; i < scene.meshes.size(); ++i) {
    const Mesh& mesh = scene.meshes[i];
    gpu::MeshRecord& record = records_[i];
    farthest_.push_back(mesh.farthest);
    copyPoint(mesh.origin, record.origin);
    copyPoint(mesh.box.lo, record.lo);
    copyPoint(mesh.box.hi, record.hi);
    record.unit = static_cast<float>(mesh.unit);
    record.perUnit = static_cast<float>(1 / mesh.unit);
    record.firstVertex = static_cast<uint32_t>(vertices);
    record.firstTriangle = static_cast<uint32_t>(triangles);
    record.firstNode = static_cast<uint32_t>(nodes);
    vertices += mesh.vertexCount();
    triangles += mesh.triangleCount();
    nodes += mesh.tree.nodes.size();
    changedMeshes_.push_back(i);
  }
  checkLimit<gpu::MeshRecord>(*device_, "meshes", records_.size());
  if (vertices > gpu::kLinkItem || triangles > gpu::kLinkItem || nodes > gpu::kLinkItem) {
    throw gpu::LimitError("the scene's meshes exceed 2^30 vertices, triangles or nodes");
  }
  buffers_.vertices.reserve(vertices);
  buffers_.triangles.reserve(triangles);
  buffers_.meshNodes.reserve(nodes);
  buffers_.meshes.reserve(records_.size());
}

// Buffers that shaders write are bound as storage buffers, so they are subject to maxStorageBufferRange.
void GpuScene::checkWriteLimits(const Scene::Impl& scene) const {
  if (!next_.objects.empty()) checkLimit<gpu::Placement>(*device_, "placements", scene.objects.size());
  if (next_.meshes.empty()) return;
  uint64_t vertices = 0, nodes = 0;
  for (const Mesh& mesh : scene.meshes) {
    vertices += mesh.vertexCount();
    nodes += mesh.tree.nodes.size();
  }
  checkLimit<gpu::Vertex>(*device_, "vertices", vertices);
  checkLimit<gpu::MeshNode>(*device_, "mesh nodes", nodes);
}

VkDeviceSize GpuScene::prepareMeshes(const Scene::Impl& scene) {
  changedMeshes_.clear();
  recordsChanged_ = seenMeshes_ != scene.meshVersion;
  VkDeviceSize bytes = 0;
  if (recordsChanged_) {
    layOut(scene);
    bytes += Upload::aligned(sizeof(gpu::MeshRecord) * records_.size());
    seenPoses_ = 0;  // placements refer to nodes
  } else {
    addDifference(overwritten_.meshes, next_.meshes, changedMeshes_);
  }
  for (const MeshId id : changedMeshes_) {
    const Mesh& mesh = scene.meshes[id];
    bytes += Upload::aligned(sizeof(gpu::Vertex) * mesh.vertexCount()) +
             Upload::aligned(sizeof(gpu::Triangle) * mesh.triangleCount()) +
             Upload::aligned(sizeof(gpu::MeshNode) * mesh.tree.nodes.size());
  }
  return bytes;
}

VkDeviceSize GpuScene::prepareIndices(const Scene::Impl& scene) {
  indicesChanged_ = hasIndices_ && seenIndices_ != scene.meshVersion;
  if (!indicesChanged_) return 0;
  VkDeviceSize bytes = 0, triangles = 0;
  for (const Mesh& mesh : scene.meshes) {
    bytes += Upload::aligned(12 * VkDeviceSize{mesh.triangleCount()});
    triangles += mesh.triangleCount();
  }
  buffers_.indices.reserve(3 * triangles);
  return bytes;
}

VkDeviceSize GpuScene::prepareObjects(const Scene::Impl& scene) {
  checkLimit<gpu::ObjectRecord>(*device_, "objects", scene.objects.size());
  const bool grew = buffers_.objects.reserve(scene.objects.size());
  if (buffers_.placements.reserve(scene.objects.size()) || grew) seenPoses_ = 0;
  changedObjects_.clear();
  if (seenPoses_ != scene.poseVersion) {
    for (ObjectId i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].used && scene.changedAt[i] > seenPoses_) changedObjects_.push_back(i);
    }
  }
  std::vector<ObjectId> restored;
  addDifference(overwritten_.objects, next_.objects, restored);
  for (const ObjectId id : restored) {
    if (scene.objects[id].used && scene.changedAt[id] <= seenPoses_) changedObjects_.push_back(id);
  }
  const ObjectTree& tree = scene.objectTree();
  treeChanged_ = buffers_.objectNodes.reserve(tree.nodes().size()) || seenTree_ != tree.version();
  return (Upload::aligned(sizeof(gpu::ObjectRecord)) + Upload::aligned(sizeof(gpu::Placement))) *
             changedObjects_.size() +
         (treeChanged_ ? Upload::aligned(sizeof(gpu::ObjectNode) * tree.nodes().size()) : 0);
}

void GpuScene::uploadMesh(const Mesh& mesh, const gpu::MeshRecord& record, Upload& upload) {
  std::vector<gpu::Vertex> vertices(mesh.vertexCount());
  for (size_t v = 0; v < vertices.size(); ++v) std::copy_n(&mesh.positions[3 * v], 3, vertices[v].position);
  std::vector<gpu::Triangle> triangles;
  triangles.reserve(mesh.triangleCount());
  for (const uint32_t id : mesh.tree.order) {
    const uint32_t* corner = &mesh.indices[3 * size_t{id}];
    triangles.push_back(
        {{record.firstVertex + corner[0], record.firstVertex + corner[1], record.firstVertex + corner[2]}, id});
  }
  std::vector<gpu::MeshNode> nodes = mesh.tree.nodes;
  for (gpu::MeshNode& node : nodes) {
    node.link += (node.link & gpu::kLinkLeaf) != 0 ? record.firstTriangle : record.firstNode;
  }
  upload.add(vertices.data(), gpu::bytesOf(vertices), buffers_.vertices,
             sizeof(gpu::Vertex) * VkDeviceSize{record.firstVertex});
  upload.add(triangles.data(), gpu::bytesOf(triangles), buffers_.triangles,
             sizeof(gpu::Triangle) * VkDeviceSize{record.firstTriangle});
  upload.add(nodes.data(), gpu::bytesOf(nodes), buffers_.meshNodes,
             sizeof(gpu::MeshNode) * VkDeviceSize{record.firstNode});
}

void GpuScene::uploadIndices(const Mesh& mesh, const gpu::MeshRecord& record, Upload& upload) const {
  std::vector<uint32_t> indices;
  indices.reserve(mesh.indices.size());
  for (const uint32_t id : mesh.tree.order) {
    for (int i = 0; i < 3; ++i) indices.push_back(record.firstVertex + mesh.indices[3 * size_t{id} + i]);
  }
  upload.add(indices.data(), gpu::bytesOf(indices), buffers_.indices, 12 * VkDeviceSize{record.firstTriangle});
}

void GpuScene::uploadObjects(const Scene::Impl& scene, Upload& upload) {
  for (const ObjectId id : changedObjects_) {
    const Object& object = scene.objects[id].object;
    gpu::ObjectRecord record{};
    std::copy(object.worldFromMesh.m.begin(), object.worldFromMesh.m.end(), record.pose);
    record.mesh = object.mesh;
    upload.add(&record, sizeof(record), buffers_.objects, sizeof(record) * VkDeviceSize{id});
  }
  for (const ObjectId id : changedObjects_) {
    const Object& object = scene.objects[id].object;
    gpu::Placement placement = placementOf(scene.meshes[object.mesh], object.worldFromMesh);
    placement.root = records_[object.mesh].firstNode;
    placement.mask = object.mask;
    placement.mesh = object.mesh;
    upload.add(&placement, sizeof(placement), buffers_.placements, sizeof(placement) * VkDeviceSize{id});
  }
}

void GpuScene::upload(const Scene::Impl& scene, Upload& upload) {
  for (const MeshId id : changedMeshes_) uploadMesh(scene.meshes[id], records_[id], upload);
  for (MeshId id = 0; indicesChanged_ && id < scene.meshes.size(); ++id) {
    uploadIndices(scene.meshes[id], records_[id], upload);
  }
  if (recordsChanged_) upload.add(records_.data(), gpu::bytesOf(records_), buffers_.meshes);
  uploadObjects(scene, upload);
  const std::vector<gpu::ObjectNode>& nodes = scene.objectTree().nodes();
  if (treeChanged_) upload.add(nodes.data(), gpu::bytesOf(nodes), buffers_.objectNodes);
}

void GpuScene::sync(const Scene::Impl& scene) {
  const VkDeviceSize bytes = prepare(scene);
  if (bytes == 0) return confirm(scene);
  if (!sync_) sync_ = std::make_unique<Sync>(Sync{gpu::Upload(*device_), gpu::Submission(*device_, false)});
  sync_->upload.begin(bytes);
  upload(scene, sync_->upload);
  const gpu::Commands commands = sync_->submission.begin();
  sync_->submission.stage("upload");
  sync_->upload.record(commands);
  gpu::transferToComputeReadWrite(commands);
  sync_->submission.submitAndWait();
  confirm(scene);
}

void GpuScene::confirm(const Scene::Impl& scene) {
  seenScene_ = scene.identity;
  seenMeshes_ = scene.meshVersion;
  if (hasIndices_) seenIndices_ = scene.meshVersion;
  seenPoses_ = scene.poseVersion;
  seenTree_ = scene.objectTree().version();
  overwritten_ = next_;
}

}  // namespace radar
