#include "sweep/resident_scene.h"

#include <algorithm>

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

VkDeviceSize ResidentScene::prepare(const Scene::Impl& scene) {
  VkDeviceSize bytes = 0;
  if (seenScene_ != scene.identity) seenMeshes_ = seenPoses_ = 0;
  meshesChanged_ = seenMeshes_ != scene.meshVersion;
  if (meshesChanged_) {
    records_.assign(scene.meshes.size(), {});
    uint64_t vertices = 0, indices = 0, nodes = 0;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
      records_[i] = {static_cast<uint32_t>(vertices), static_cast<uint32_t>(indices), static_cast<uint32_t>(nodes)};
      vertices += scene.meshes[i].vertexCount();
      indices += scene.meshes[i].indices.size();
      nodes += scene.meshes[i].clusters.nodes.size();
      bytes += 2 * Upload::aligned(12 * VkDeviceSize{scene.meshes[i].vertexCount()}) +
               Upload::aligned(4 * scene.meshes[i].indices.size()) +
               Upload::aligned(4 * scene.meshes[i].clusters.order.size()) +
               Upload::aligned(sizeof(gpu::ClusterRecord) * scene.meshes[i].clusters.nodes.size());
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
  }
  changedObjects_.clear();
  if (seenPoses_ != scene.poseVersion) {
    refuseAbove("objects", sizeof(gpu::ObjectRecord) * scene.objects.size());
    if (buffers_.objects.reserve(sizeof(gpu::ObjectRecord) * scene.objects.size())) seenPoses_ = 0;
    for (ObjectId i = 0; i < scene.objects.size(); ++i) {
      if (scene.objects[i].used && scene.changedAt[i] > seenPoses_) changedObjects_.push_back(i);
    }
    bytes += Upload::aligned(sizeof(gpu::ObjectRecord)) * changedObjects_.size();
  }
  return bytes;
}

void ResidentScene::upload(const Scene::Impl& scene, Upload& upload) {
  if (meshesChanged_) {
    std::vector<float> interleaved;
    std::vector<uint32_t> ordered;
    std::vector<gpu::ClusterRecord> records;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
      const Mesh& mesh = scene.meshes[i];
      interleaved.resize(mesh.positions.size());
      for (size_t v = 0; v < mesh.vertexCount(); ++v) {
        for (int k = 0; k < 3; ++k) interleaved[3 * v + k] = mesh.recentred[k][v];
      }
      const VkDeviceSize bytes = 4 * interleaved.size(), at = 12 * VkDeviceSize{records_[i].firstVertex};
      upload.add(interleaved.data(), bytes, buffers_.positions, at);
      upload.add(mesh.positions.data(), bytes, buffers_.originals, at);
      const Clusters& clusters = mesh.clusters;
      ordered.clear();
      for (uint32_t triangle : clusters.order) {
        const auto corner = mesh.indices.begin() + 3 * size_t{triangle};
        ordered.insert(ordered.end(), corner, corner + 3);
      }
      const VkDeviceSize firstIndex = records_[i].firstIndex;
      upload.add(ordered.data(), 4 * ordered.size(), buffers_.indices, 4 * firstIndex);
      upload.add(clusters.order.data(), 4 * clusters.order.size(), buffers_.triangleIds, 4 * firstIndex / 3);
      records.clear();
      for (const ClusterNode& node : clusters.nodes) {
        gpu::ClusterRecord record{{}, {}, {}, node.first, node.count};
        std::copy(node.centre.begin(), node.centre.end(), record.centre);
        std::copy(node.half.begin(), node.half.end(), record.halfExtent);
        std::copy(node.edge.begin(), node.edge.end(), record.edge);
        records.push_back(record);
      }
      upload.add(records.data(), sizeof(gpu::ClusterRecord) * records.size(), buffers_.nodes,
                 sizeof(gpu::ClusterRecord) * VkDeviceSize{records_[i].firstNode});
    }
    upload.add(records_.data(), sizeof(gpu::MeshRecord) * records_.size(), buffers_.meshes);
  }
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
}

void ResidentScene::bindTo(gpu::Bindings& bindings) const {
  bindings.setBuffer(gpu::kBindPositions, buffers_.positions);
  bindings.setBuffer(gpu::kBindOriginals, buffers_.originals);
  bindings.setBuffer(gpu::kBindIndices, buffers_.indices);
  bindings.setBuffer(gpu::kBindMeshes, buffers_.meshes);
  bindings.setBuffer(gpu::kBindObjects, buffers_.objects);
}

}  // namespace radar
