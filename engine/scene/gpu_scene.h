// A scene's copy on a device: meshes, their trees, objects and the tree over them, one buffer per kind.
#pragma once

#include <memory>

#include "gpu/array.h"
#include "gpu/submission.h"
#include "scene/scene.h"
#include "shaders/shared/interop.h"

namespace radar {

class GpuScene {
 public:
  explicit GpuScene(const Device::Impl& device);

  struct Buffers {
    gpu::TexelArray<gpu::Vertex> vertices;
    gpu::TexelArray<gpu::Triangle> triangles;  ///< in the order of the mesh's tree
    gpu::TexelArray<gpu::MeshNode> meshNodes;
    gpu::Array<gpu::MeshRecord> meshes;
    gpu::Array<gpu::ObjectRecord> objects;
    gpu::TexelArray<gpu::Placement> placements;
    gpu::TexelArray<gpu::ObjectNode> objectNodes;
    gpu::Array<uint32_t> indices;  ///< 3 vertices per triangle, for drawing; empty until needIndices()
  };

  /// Makes the next prepare() fill the index buffer, too.
  void needIndices() { hasIndices_ = true; }
  bool hasIndices() const { return hasIndices_; }

  /// Declares the meshes and objects that commands after the next upload overwrite. Those overwritten after the last
  /// upload, and not now, are staged again from the scene.
  struct Overwritten {
    std::vector<MeshId> meshes;
    std::vector<ObjectId> objects;
  };
  void willOverwrite(Overwritten next);

  /// Finds the changes and makes room for them; returns the bytes that `upload` will stage. Throws if they do not fit a
  /// buffer of the device.
  VkDeviceSize prepare(const Scene::Impl& scene);
  /// Stages the changes found by the last `prepare`.
  void upload(const Scene::Impl& scene, gpu::Upload& upload);
  /// Marks staged changes as uploaded. Without this call, as after a failed submission, they are staged again.
  void confirm(const Scene::Impl& scene);
  /// Uploads the changes and waits. The device must have a queue.
  void sync(const Scene::Impl& scene);
  /// Marks all uploads as uncertain: everything is staged again.
  void forget();

  const Buffers& buffers() const { return buffers_; }
  /// A mesh's place in the buffers, after prepare().
  const gpu::MeshRecord& record(MeshId mesh) const { return records_[mesh]; }
  /// Mesh::farthest, as of the last prepare().
  const Vector& farthest(MeshId mesh) const { return farthest_[mesh]; }

 private:
  void checkWriteLimits(const Scene::Impl& scene) const;
  VkDeviceSize prepareMeshes(const Scene::Impl& scene);
  VkDeviceSize prepareIndices(const Scene::Impl& scene);
  VkDeviceSize prepareObjects(const Scene::Impl& scene);
  void layOut(const Scene::Impl& scene);
  void uploadMesh(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload);
  void uploadIndices(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload) const;
  void uploadObjects(const Scene::Impl& scene, gpu::Upload& upload);

  const Device::Impl* device_;
  Buffers buffers_;
  std::vector<gpu::MeshRecord> records_;
  std::vector<Vector> farthest_;  ///< of each mesh
  uint64_t seenScene_ = 0, seenMeshes_ = 0, seenIndices_ = 0, seenPoses_ = 0, seenTree_ = 0;
  bool hasIndices_ = false, recordsChanged_ = false, indicesChanged_ = false, treeChanged_ = false;
  std::vector<MeshId> changedMeshes_;
  std::vector<ObjectId> changedObjects_;
  Overwritten overwritten_, next_;  ///< ascending
  struct Sync {
    gpu::Upload upload;
    gpu::Submission submission;
  };
  std::unique_ptr<Sync> sync_;  ///< made when first needed, since there may be no queue
};

}  // namespace radar
