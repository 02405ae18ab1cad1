// A scene's copy on a device: meshes, their trees, objects and the tree over them, each kind in one buffer.
#pragma once

#include <memory>

#include "gpu/array.h"
#include "gpu/submission.h"
#include "scene/scene.h"
#include "shaders/contact/interop.h"

namespace radar {

class GpuScene {
 public:
  explicit GpuScene(const Device::Impl& device);

  struct Buffers {
    gpu::TexelArray<gpu::Vertex> vertices;
    gpu::TexelArray<gpu::Triangle> triangles;  ///< in the order of their mesh's tree
    gpu::TexelArray<gpu::MeshNode> meshNodes;
    gpu::Array<gpu::MeshRecord> meshes;
    gpu::Array<gpu::ObjectRecord> objects;
    gpu::TexelArray<gpu::Placement> placements;
    gpu::TexelArray<gpu::ObjectNode> objectNodes;
    gpu::Array<uint32_t> indices;  ///< 3 vertices a triangle, for drawing; empty until needIndices()
  };

  /// From the next prepare() on the buffer of indices is there, too.
  void needIndices() { hasIndices_ = true; }
  bool hasIndices() const { return hasIndices_; }

  /// Meshes and objects that commands behind the next upload overwrite. What those behind the last one have
  /// overwritten, and these do not, is staged as the scene has it.
  struct Overwritten {
    std::vector<MeshId> meshes;
    std::vector<ObjectId> objects;
  };
  void willOverwrite(Overwritten next);

  /// Works out what changed and makes room for it; returns the bytes that `upload` will stage. Throws where a buffer of
  /// the device cannot hold it.
  VkDeviceSize prepare(const Scene::Impl& scene);
  /// Stages the changes found by the last `prepare`.
  void upload(const Scene::Impl& scene, gpu::Upload& upload);
  /// What was staged has arrived: until then a failed submission leaves it to be staged again.
  void confirm(const Scene::Impl& scene);
  /// Brings what changed to the device, whose queue is there, and waits.
  void sync(const Scene::Impl& scene);
  /// Nothing that was staged has arrived for certain: all of it is staged again.
  void forget();

  const Buffers& buffers() const { return buffers_; }
  /// Where a mesh is, after prepare().
  const gpu::MeshRecord& record(MeshId mesh) const { return records_[mesh]; }

 private:
  void refuseTooLargeToWrite(const Scene::Impl& scene) const;
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
  uint64_t seenScene_ = 0, seenMeshes_ = 0, seenIndices_ = 0, seenPoses_ = 0, seenTree_ = 0;
  bool hasIndices_ = false, recordsChanged_ = false, indicesChanged_ = false, treeChanged_ = false;
  std::vector<MeshId> changedMeshes_;
  std::vector<ObjectId> changedObjects_;
  Overwritten overwritten_, next_;  ///< ascending
  struct Sync {
    gpu::Upload upload;
    gpu::Submission submission;
  };
  std::unique_ptr<Sync> sync_;  ///< made when first needed: there may be no queue
};

}  // namespace radar
