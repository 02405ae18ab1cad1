#include "sweep/resident_scene.h"

#include <algorithm>
#include <iterator>

namespace radar {

using gpu::Residence;
using gpu::Upload;

ResidentScene::ResidentScene(const Device::Impl& device)
    : device_(&device),
      buffers_{
          {device, "positions", Residence::device,
           VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "originals", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "indices", Residence::device,
           VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "triangle ids", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "cluster nodes", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "meshes", Residence::device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "objects", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT}} {}

void ResidentScene::refuseAbove(const char* what, uint64_t bytes) const {
  const uint64_t limit = device_->properties.limits.maxStorageBufferRange;
  if (bytes <= limit) return;
  throw Error(std::string("the scene's ") + what + " need a buffer of " + std::to_string(bytes) +
              " bytes, the device allows " + std::to_string(limit));
}

void ResidentScene::willOverwrite(Overwritten next) {
  next_ = std::move(next);
  std::sort(next_.meshes.begin(), next_.meshes.end());
  std::sort(next_.objects.begin(), next_.objects.end());
}

void ResidentScene::forget() {
  seenScene_ = seenMeshes_ = seenPoses_ = 0;
  overwritten_ = {};
}

VkDeviceSize ResidentScene::prepare(const Scene::Impl& scene) {
  if (seenScene_ != scene.identity) forget();
  const VkDeviceSize meshes = prepareMeshes(scene);
  return meshes + prepareObjects(scene);
}

VkDeviceSize ResidentScene::prepareMeshes(const Scene::Impl& scene) {
  VkDeviceSize bytes = 0;
  changedMeshes_.clear();
  recordsChanged_ = seenMeshes_ != scene.meshVersion;
  if (recordsChanged_) {
    records_.assign(scene.meshes.size(), {});
    uint64_t vertices = 0, indices = 0, nodes = 0;
    for (MeshId i = 0; i < scene.meshes.size(); ++i) {
      const Mesh& mesh = scene.meshes[i];
      gpu::MeshRecord& record = records_[i];
      for (int k = 0; k < 3; ++k) {
        record.centre[k] = static_cast<float>(mesh.centre[k]);
        record.halfExtent[k] = mesh.halfExtent[k];
      }
      record.firstVertex = static_cast<uint32_t>(vertices);
      record.firstIndex = static_cast<uint32_t>(indices);
      record.firstNode = static_cast<uint32_t>(nodes);
      vertices += mesh.vertexCount();
      indices += mesh.indices.size();
      nodes += mesh.clusters.nodes.size();
      changedMeshes_.push_back(i);
    }
    if (vertices > UINT32_MAX || indices > UINT32_MAX)
      throw Error("the scene's meshes exceed 2^32 vertices or indices");
    refuseAbove("vertices", 12 * vertices);
    refuseAbove("triangles", 4 * indices);
    refuseAbove("clusters", sizeof(gpu::ClusterRecord) * nodes);
    buffers_.positions.reserve(12 * vertices);
    buffers_.originals.reserve(12 * vertices);
    buffers_.indices.reserve(4 * indices);
    buffers_.triangleIds.reserve(4 * indices / 3);
    buffers_.nodes.reserve(sizeof(gpu::ClusterRecord) * nodes);
    buffers_.meshes.reserve(sizeof(gpu::MeshRecord) * records_.size());
    bytes += Upload::aligned(sizeof(gpu::MeshRecord) * records_.size());
  } else {
    std::set_difference(overwritten_.meshes.begin(), overwritten_.meshes.end(), next_.meshes.begin(),
                        next_.meshes.end(), std::back_inserter(changedMeshes_));
  }
  for (const MeshId id : changedMeshes_) {
    const Mesh& mesh = scene.meshes[id];
    bytes += 2 * Upload::aligned(12 * VkDeviceSize{mesh.vertexCount()}) + Upload::aligned(4 * mesh.indices.size()) +
             Upload::aligned(4 * mesh.clusters.order.size()) +
             Upload::aligned(sizeof(gpu::ClusterRecord) * mesh.clusters.nodes.size());
  }
  return bytes;
}

VkDeviceSize ResidentScene::prepareObjects(const Scene::Impl& scene) {
  refuseAbove("objects", sizeof(gpu::ObjectRecord) * scene.objects.size());
  if (buffers_.objects.reserve(sizeof(gpu::ObjectRecord) * scene.objects.size())) seenPoses_ = 0;
  changedObjects_.clear();
  if (seenPoses_ != scene.poseVersion) {
    for (ObjectId i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].used && scene.changedAt[i] > seenPoses_) changedObjects_.push_back(i);
    }
  }
  std::vector<ObjectId> restored;
  std::set_difference(overwritten_.objects.begin(), overwritten_.objects.end(), next_.objects.begin(),
                      next_.objects.end(), std::back_inserter(restored));
  for (const ObjectId id : restored) {
    if (scene.objects[id].used && scene.changedAt[id] <= seenPoses_) changedObjects_.push_back(id);
  }
  return Upload::aligned(sizeof(gpu::ObjectRecord)) * changedObjects_.size();
}

void ResidentScene::uploadMesh(const Mesh& mesh, const gpu::MeshRecord& record, Upload& upload) const {
  std::vector<float> interleaved(mesh.positions.size());
  for (size_t v = 0; v < mesh.vertexCount(); ++v) {
    for (int k = 0; k < 3; ++k) interleaved[3 * v + k] = mesh.recentred[k][v];
  }
  const VkDeviceSize bytes = 4 * interleaved.size(), at = 12 * VkDeviceSize{record.firstVertex};
  upload.add(interleaved.data(), bytes, buffers_.positions, at);
  upload.add(mesh.positions.data(), bytes, buffers_.originals, at);
  std::vector<uint32_t> ordered;
  for (uint32_t triangle : mesh.clusters.order) {
    const auto corner = mesh.indices.begin() + 3 * size_t{triangle};
    ordered.insert(ordered.end(), corner, corner + 3);
  }
  const VkDeviceSize firstIndex = record.firstIndex;
  upload.add(ordered.data(), 4 * ordered.size(), buffers_.indices, 4 * firstIndex);
  upload.add(mesh.clusters.order.data(), 4 * mesh.clusters.order.size(), buffers_.triangleIds, 4 * firstIndex / 3);
  std::vector<gpu::ClusterRecord> nodes;
  for (const ClusterNode& node : mesh.clusters.nodes) {
    gpu::ClusterRecord out{{}, {}, {}, node.first, node.count};
    std::copy(node.centre.begin(), node.centre.end(), out.centre);
    std::copy(node.half.begin(), node.half.end(), out.halfExtent);
    std::copy(node.edge.begin(), node.edge.end(), out.edge);
    nodes.push_back(out);
  }
  upload.add(nodes.data(), sizeof(gpu::ClusterRecord) * nodes.size(), buffers_.nodes,
             sizeof(gpu::ClusterRecord) * VkDeviceSize{record.firstNode});
}

void ResidentScene::upload(const Scene::Impl& scene, Upload& upload) {
  for (const MeshId id : changedMeshes_) uploadMesh(scene.meshes[id], records_[id], upload);
  if (recordsChanged_) upload.add(records_.data(), sizeof(gpu::MeshRecord) * records_.size(), buffers_.meshes);
  for (ObjectId id : changedObjects_) {
    const Object& object = scene.objects[id].object;
    gpu::ObjectRecord record{};
    std::copy(object.worldFromMesh.m.begin(), object.worldFromMesh.m.end(), record.pose);
    record.mesh = object.mesh;
    upload.add(&record, sizeof(record), buffers_.objects, sizeof(record) * VkDeviceSize{id});
  }
}

void ResidentScene::confirm(const Scene::Impl& scene) {
  seenScene_ = scene.identity;
  seenMeshes_ = scene.meshVersion;
  seenPoses_ = scene.poseVersion;
  overwritten_ = next_;
}

void ResidentScene::bindTo(gpu::Bindings& bindings) const {
  bindings.setBuffer(gpu::kBindPositions, buffers_.positions);
  bindings.setBuffer(gpu::kBindOriginals, buffers_.originals);
  bindings.setBuffer(gpu::kBindIndices, buffers_.indices);
  bindings.setBuffer(gpu::kBindMeshes, buffers_.meshes);
  bindings.setBuffer(gpu::kBindObjects, buffers_.objects);
}

}  // namespace radar
