// A scene's copy on a device: all meshes in one pair of position buffers and one index buffer, all poses in one.
#pragma once

#include "gpu/buffer.h"
#include "gpu/pipeline.h"
#include "scene/scene.h"
#include "shaders/interop.h"

namespace radar {

class ResidentScene {
 public:
  explicit ResidentScene(const Device::Impl& device);

  struct Buffers {
    gpu::Buffer positions, originals, indices, triangleIds, nodes, meshes, objects;
  };

  /// Meshes and objects that commands behind the next upload overwrite. What those behind the last one have
  /// overwritten, and these do not, is staged as the scene has it.
  struct Overwritten {
    std::vector<MeshId> meshes;
    std::vector<ObjectId> objects;
  };
  void willOverwrite(Overwritten next);

  /// Works out what changed and makes room for it; returns the bytes that `upload` will stage.
  VkDeviceSize prepare(const Scene::Impl& scene);
  /// Stages the changes found by the last `prepare`.
  void upload(const Scene::Impl& scene, gpu::Upload& upload);
  /// What was staged has arrived: until then a failed submission leaves it to be staged again.
  void confirm(const Scene::Impl& scene);

  /// Nothing that was staged has arrived for certain: all of it is staged again.
  void forget();

  /// Binds what every set has at the same numbers: all but triangle ids and nodes.
  void bindTo(gpu::Bindings& bindings) const;
  const Buffers& buffers() const { return buffers_; }
  const gpu::MeshRecord& record(MeshId mesh) const { return records_[mesh]; }

 private:
  void refuseAbove(const char* what, uint64_t bytes) const;
  VkDeviceSize prepareMeshes(const Scene::Impl& scene);
  VkDeviceSize prepareObjects(const Scene::Impl& scene);
  void uploadMesh(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload) const;

  const Device::Impl* device_;
  Buffers buffers_;
  std::vector<gpu::MeshRecord> records_;
  uint64_t seenScene_ = 0, seenMeshes_ = 0, seenPoses_ = 0;
  bool recordsChanged_ = false;
  std::vector<MeshId> changedMeshes_;
  std::vector<ObjectId> changedObjects_;
  Overwritten overwritten_, next_;  ///< ascending
};

}  // namespace radar
