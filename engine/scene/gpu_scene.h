// A scene's copy on a device: meshes, their trees, objects and the tree over them, one buffer per kind.
#pragma once

#include <memory>

#include "gpu/array.h"
#include "gpu/submission.h"
#include "scene/arena.h"
#include "scene/scene.h"
#include "shaders/shared/interop.h"

namespace radar {

class GpuScene {
 public:
  explicit GpuScene(const Device::Impl& device);

  struct Buffers {
    explicit Buffers(const Device::Impl& device);
    gpu::Array<gpu::Vertex> vertices;
    gpu::Array<gpu::Triangle> triangles;  ///< in the order of the mesh's tree
    gpu::Array<gpu::MeshNode> meshNodes;
    gpu::Array<gpu::MeshRecord> meshes;
    gpu::Array<gpu::ObjectRecord> objects;
    gpu::Array<gpu::Placement> placements;
    gpu::Array<gpu::ObjectNode> objectNodes;
    gpu::Array<uint32_t> indices;  ///< 3 vertices per triangle, for drawing; empty until needIndices()
  };

  /// Makes the next prepare() fill the index buffer, too.
  void needIndices() { hasIndices_ = true; }
  bool hasIndices() const { return hasIndices_; }

  struct Moved {
    std::vector<ObjectId> objects;   ///< with their placements; ascending
    std::vector<ObjectId> standing;  ///< of which only the placements are overwritten; ascending
    std::vector<uint32_t> nodes;     ///< of the tree over objects, ascending
  };
  struct Overwritten {
    std::vector<MeshId> meshes;          ///< in any order
    std::shared_ptr<const Moved> moved;  ///< null: none; shared, since there may be millions
  };
  /// Declares what commands after the next upload overwrite. What was overwritten after the last upload, and is not
  /// now, is staged again from the scene.
  void willOverwrite(Overwritten next);

  /// Finds the changes and makes room for them; returns the bytes that `upload` will stage. Throws if they do not fit a
  /// buffer of the device.
  VkDeviceSize prepare(const Scene::Impl& scene);
  /// Stages the changes found by the last `prepare`.
  void upload(const Scene::Impl& scene, gpu::Upload& upload);
  /// Marks staged changes as uploaded, and overwritten what willOverwrite() declared. Throws nothing. Without this
  /// call, as after a failed submission, they are staged again.
  void confirm(const Scene::Impl& scene);
  /// Uploads the changes and waits. The device must have a queue.
  void sync(const Scene::Impl& scene);
  /// Marks all uploads as uncertain: everything is staged again.
  void forget();

  const Buffers& buffers() const { return *buffers_; }
  /// Keeps the buffers while submitted commands use them: if they must grow meanwhile, others take their place.
  std::shared_ptr<const Buffers> shareBuffers() const { return buffers_; }
  /// A mesh's place in the buffers, after prepare().
  const gpu::MeshRecord& record(MeshId mesh) const { return records_[mesh]; }
  /// Mesh::farthest of each mesh, as of the last prepare().
  using Farthest = std::shared_ptr<const std::vector<Vector>>;
  const Farthest& farthest() const { return farthest_; }

 private:
  /// A mesh on the device. Its ranges in the buffers are kept as long as it has the same numbers of elements.
  struct Place {
    uint64_t vertices = 0, triangles = 0, nodes = 0;  ///< numbers of elements; none: no mesh
    uint64_t uploaded = 0, uploadedIndices = 0;       ///< Mesh::version of what is in the buffers; 0: nothing
  };
  void clear();
  bool fits(const Scene::Impl& scene) const;
  void checkWriteLimits(const Scene::Impl& scene) const;
  VkDeviceSize prepareMeshes(const Scene::Impl& scene);
  VkDeviceSize prepareIndices(const Scene::Impl& scene);
  VkDeviceSize prepareObjects(const Scene::Impl& scene);
  VkDeviceSize prepareTree(const ObjectTree& tree);
  const Moved& movedBefore() const;
  const Moved& movedNext() const;
  void placeMeshes(const Scene::Impl& scene);
  bool placeMesh(MeshId id, const Mesh& mesh);
  void removePlace(MeshId id);
  void layOut(const Scene::Impl& scene);
  bool exceedsWriteLimits() const;
  void describe(MeshId id, const Mesh& mesh);
  void uploadMesh(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload);
  void uploadIndices(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload) const;
  void uploadObjects(const Scene::Impl& scene, gpu::Upload& upload);

  const Device::Impl* device_;
  std::shared_ptr<Buffers> buffers_;
  Arena vertices_, triangles_, nodes_;  ///< of the buffers
  std::vector<Place> places_;           ///< by mesh
  std::vector<gpu::MeshRecord> records_;
  Farthest farthest_;
  uint64_t seenScene_ = 0, seenMeshes_ = 0, seenPoses_ = 0, seenTree_ = 0;
  bool hasIndices_ = false, recordsChanged_ = false;
  std::vector<MeshId> changedMeshes_, changedIndices_;
  std::vector<ObjectId> changedObjects_;  ///< ascending
  struct Range {
    size_t first, last;
  };
  std::vector<Range> changedNodes_;
  Overwritten overwritten_, next_;  ///< meshes ascend
  struct Sync {
    gpu::Upload upload;
    gpu::Submission submission;
  };
  std::unique_ptr<Sync> sync_;  ///< made when first needed, since there may be no queue
};

}  // namespace radar
