#include "sweep/resident_scene.h"

#include <algorithm>

namespace radar {

using gpu::Residence;
using gpu::Upload;

ResidentScene::ResidentScene(const Device::Impl& device)
    : buffers_{
          {device, "positions", Residence::device,
           VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "originals", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "indices", Residence::device,
           VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "meshes", Residence::device, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT},
          {device, "objects", Residence::device,
           VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT}} {}

VkDeviceSize ResidentScene::prepare(const Scene::Impl& scene) {
  VkDeviceSize bytes = 0;
  meshesChanged_ = seenMeshes_ != scene.meshVersion;
  if (meshesChanged_) {
    records_.assign(scene.meshes.size(), {});
    uint64_t vertices = 0, indices = 0;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
      records_[i] = {static_cast<uint32_t>(vertices), static_cast<uint32_t>(indices)};
      vertices += scene.meshes[i].vertexCount();
      indices += scene.meshes[i].indices.size();
      bytes += 2 * Upload::aligned(12 * VkDeviceSize{scene.meshes[i].vertexCount()}) +
               Upload::aligned(4 * scene.meshes[i].indices.size());
    }
    if (vertices > UINT32_MAX || indices > UINT32_MAX)
      throw Error("the scene's meshes exceed 2^32 vertices or indices");
    buffers_.positions.reserve(12 * vertices);
    buffers_.originals.reserve(12 * vertices);
    buffers_.indices.reserve(4 * indices);
    buffers_.meshes.reserve(sizeof(gpu::MeshRecord) * records_.size());
    bytes += Upload::aligned(sizeof(gpu::MeshRecord) * records_.size());
  }
  changedObjects_.clear();
  if (seenPoses_ != scene.poseVersion) {
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
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
      const Mesh& mesh = scene.meshes[i];
      interleaved.resize(mesh.positions.size());
      for (size_t v = 0; v < mesh.vertexCount(); ++v) {
        for (int k = 0; k < 3; ++k) interleaved[3 * v + k] = mesh.recentred[k][v];
      }
      const VkDeviceSize bytes = 4 * interleaved.size(), at = 12 * VkDeviceSize{records_[i].firstVertex};
      upload.add(interleaved.data(), bytes, buffers_.positions, at);
      upload.add(mesh.positions.data(), bytes, buffers_.originals, at);
      upload.add(mesh.indices.data(), 4 * mesh.indices.size(), buffers_.indices,
                 4 * VkDeviceSize{records_[i].firstIndex});
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
  seenMeshes_ = scene.meshVersion;
  seenPoses_ = scene.poseVersion;
}

}  // namespace radar
