// A scene's copy on a device: meshes, their trees, objects and the tree over them, one buffer per kind.
#pragma once

#include <memory>
#include <utility>

#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "scene/arena.h"
#include "scene/scene.h"
#include "shaders/shared/interop.h"

namespace radar {

class GpuScene {
 public:
  explicit GpuScene(const Device::Impl& device);

  struct Buffers {
    explicit Buffers(const gpu::Owner& owner);
    gpu::Array<gpu::Vertex> vertices;
    gpu::Array<gpu::Triangle> triangles;  ///< in the order of the mesh's tree
    gpu::Array<gpu::MeshNode> meshNodes;
    gpu::Array<gpu::MeshRecord> meshes;
    gpu::Array<gpu::ObjectRecord> objects;
    gpu::Array<gpu::Placement> placements;
    gpu::Array<gpu::ObjectNode> objectNodes;
    gpu::Array<uint32_t> indices;  ///< 3 vertices per triangle, for drawing; empty until needIndices()
  };

  /// Makes the next stage() fill the index buffer, too.
  void needIndices() { hasIndices_ = true; }
  bool hasIndices() const { return hasIndices_; }

  struct Moved {
    std::vector<ObjectId> objects;   ///< with their placements; ascending
    std::vector<ObjectId> standing;  ///< of which only the placements are overwritten; ascending
    std::vector<uint32_t> nodes;     ///< of the tree over objects, ascending
    uint32_t built = 0;              ///< nodes that are built behind those
  };
  struct Overwritten {
    std::vector<MeshId> meshes;          ///< in any order
    std::shared_ptr<const Moved> moved;  ///< null: none; shared, since there may be millions
  };
  /// Versions of what is on the device; 0: nothing.
  struct Seen {
    uint64_t scene = 0, meshes = 0, poses = 0, tree = 0;
    Overwritten overwritten;
  };
  /// What commit() needs of the changes that stage() has staged.
  struct Staged {
    uint64_t era = 0;
    Seen seen;
    std::vector<std::pair<MeshId, uint64_t>> meshes, indices;  ///< with Mesh::version
  };

  /// Finds the changes, makes room for them in the buffers, and stages them. `next`: what commands after the upload
  /// overwrite; what they overwrote after the last, and will not now, is staged from the scene. Throws if something
  /// does not fit a buffer of the device.
  Staged stage(const Scene::Impl& scene, Overwritten next, gpu::Upload& upload);
  /// Marks staged changes as uploaded, and `next` as overwritten, unless stage() has thrown since or forget() was
  /// called. Without this call, as after a failed submission, the changes are staged again.
  void commit(Staged staged) noexcept;
  /// Uploads the changes and waits. The device must have a queue.
  void sync(const Scene::Impl& scene);
  /// Frees the host memory that sync() has used, which is as large as what it uploaded.
  void dropStaging() { sync_.reset(); }
  /// Marks all uploads as uncertain: everything is staged again.
  void forget();

  const Buffers& buffers() const { return *buffers_; }
  /// Keeps the buffers while submitted commands use them: if they must grow meanwhile, others take their place.
  std::shared_ptr<const Buffers> shareBuffers() const { return buffers_; }
  /// A mesh's place in the buffers, after stage().
  const gpu::MeshRecord& record(MeshId mesh) const { return records_[mesh]; }
  /// Mesh::farthest of each mesh, as of the last stage().
  using Farthest = std::shared_ptr<const std::vector<Vector>>;
  const Farthest& farthest() const { return farthest_; }
  /// Bytes of its buffers on the device.
  uint64_t memoryUse() const { return owner_.bytes(); }

 private:
  /// A mesh on the device. Its ranges in the buffers are kept as long as it has the same numbers of elements.
  struct Place {
    uint64_t vertices = 0, triangles = 0, nodes = 0;  ///< numbers of elements; none: no mesh
    uint64_t uploaded = 0, uploadedIndices = 0;       ///< Mesh::version of what is in the buffers; 0: nothing
  };
  void clear();
  bool fits(const Scene::Impl& scene, const Overwritten& next) const;
  void checkWriteLimits(const Scene::Impl& scene, const Overwritten& next) const;
  void placeMeshes(const Scene::Impl& scene, const Overwritten& next);
  bool placeMesh(MeshId id, const Mesh& mesh);
  void removePlace(MeshId id);
  void layOut(const Scene::Impl& scene);
  bool exceedsWriteLimits(const Overwritten& next) const;
  void describe(MeshId id, const Mesh& mesh);
  void stageMesh(const Mesh& mesh, const gpu::MeshRecord& record, gpu::Upload& upload) const;
  void stageMeshes(const Scene::Impl& scene, Staged& staged, gpu::Upload& upload);
  void stageIndices(const Scene::Impl& scene, Staged& staged, gpu::Upload& upload);
  std::vector<ObjectId> changedObjects(const Scene::Impl& scene, const Overwritten& next) const;
  void stageObjects(const Scene::Impl& scene, const Overwritten& next, gpu::Upload& upload);
  void stageTree(const ObjectTree& tree, const Overwritten& next, gpu::Upload& upload);

  gpu::Owner owner_;
  std::shared_ptr<Buffers> buffers_;
  Arena vertices_, triangles_, nodes_;  ///< of the buffers
  std::vector<Place> places_;           ///< by mesh
  std::vector<gpu::MeshRecord> records_;
  Farthest farthest_;
  Seen seen_;         ///< overwritten meshes ascend
  uint64_t era_ = 0;  ///< ends with forget()
  bool hasIndices_ = false;
  struct Sync {
    gpu::Upload upload;
    gpu::Submission submission;
  };
  std::unique_ptr<Sync> sync_;  ///< made when first needed, since there may be no queue
};

/// What a user of the copy adds to the memory that it takes: that of the copy if nobody shares it.
inline uint64_t memoryAlone(const std::shared_ptr<GpuScene>& copy) {
  return copy.use_count() == 1 ? copy->memoryUse() : 0;
}

}  // namespace radar
