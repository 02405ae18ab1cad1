// What the device works through for a host's geometry: computed from it and the scene, and kept while those stay the
// same.
#pragma once

#include <array>
#include <memory>
#include <span>
#include <vector>

#include "radar/host.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

/// Meshes that a host deforms.
struct DeformedList {
  std::vector<uint64_t> key{};  ///< all that the rest depends on
  std::vector<gpu::Deformed> meshes{};
  std::vector<uint32_t> firstHostVertices{};  ///< of each of them
  std::vector<MeshId> unbounded{};            ///< those without bounds
  std::array<uint32_t, 2> groups{};           ///< workgroups of deform.comp and bound.comp
  std::vector<gpu::RefitNode> refitNodes{};
  std::vector<uint32_t> refitEnds{};  ///< where each depth ends in `refitNodes`
  bool isUploaded = false;
};

/// Objects that a host moves, and those that stand, but whose meshes it deforms without bounds.
struct MovedList {
  std::vector<uint64_t> key{};  ///< with `named`, all that the rest depends on
  std::vector<ObjectId> named{};
  std::vector<gpu::Moved> moved{};
  std::vector<ObjectId> unbounded{};  ///< without bounds: only the device knows where they are. Ascending
  std::vector<uint32_t> parts{};      ///< of the tree over objects: see MovedTree; none if it has none of those
  std::shared_ptr<const GpuScene::Moved> overwritten{};
  bool isUploaded = false;
};

/// How many objects the host moves together, and the k-th of them.
inline size_t countOf(const MovedObjects& group) {
  return group.objects.size() + group.count;
}
inline ObjectId objectOf(const MovedObjects& group, size_t k) {
  return group.objects.empty() ? static_cast<ObjectId>(group.firstObject + k) : group.objects[k];
}

/// Lists valid geometry, or leaves `list` as it is if it would be the same. If this throws, the list is empty.
/// `firstBytes`: where the copied words have the positions of each mesh.
void update(DeformedList& list, const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
            const Scene::Impl& scene);
/// The same; `firstBytes`: of the transforms of each group of objects; `meshes`: deformed without bounds. Throws Error
/// if an object does not exist or is named twice.
void update(MovedList& list, const HostGeometry& geometry, std::span<const uint32_t> firstBytes,
            std::span<const MeshId> meshes, const Scene::Impl& scene);

}  // namespace radar
