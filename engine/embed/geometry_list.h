// What the device works through for a host's geometry: computed from it and the scene, and kept while those stay the
// same.
#pragma once

#include <span>
#include <vector>

#include "radar/host.h"
#include "scene/gpu_scene.h"
#include "shaders/embed/interop.h"

namespace radar {

struct GeometryList {
  struct Deformed {
    MeshId mesh;
    uint32_t vertices, triangles;
    uint32_t firstByte, stride, component;  ///< of the positions, in the copied words
    uint32_t firstHostVertex;
    uint32_t numbers;  ///< where `vertexNumbers` has those of its vertices, less the first's; kNone: consecutive
    bool isBounded;
  };
  /// Nodes of a mesh at one depth, refitted together.
  struct Level {
    MeshId mesh;
    uint32_t first, count;  ///< in `refitNodes`
  };

  std::vector<uint64_t> key;    ///< with `named`, all that the rest depends on
  std::vector<ObjectId> named;  ///< by the geometry, in its order

  std::vector<Deformed> meshes;
  std::vector<uint32_t> vertexNumbers;
  std::vector<MeshId> unboundedMeshes;     ///< of these meshes, those without bounds
  std::vector<uint32_t> refitNodes;        ///< of these meshes
  std::vector<std::vector<Level>> levels;  ///< over all meshes; the deepest last
  std::vector<gpu::Moved> moved;           ///< the named objects, then those that stand, but whose meshes are unbounded
  std::vector<ObjectId> unbounded;         ///< moved objects without bounds: only the device knows where. Ascending
  std::vector<uint32_t> fitNodes, fitEnds;  ///< inner nodes above those, the root first, and where each depth ends
  GpuScene::Overwritten overwritten;        ///< by the device

  bool empty() const { return meshes.empty() && moved.empty(); }
  /// Whether a list of this would be the same. `firstBytes`: where the copied words have the positions of each mesh,
  /// then the transforms of each group of objects.
  bool isOf(const HostGeometry& geometry, std::span<const uint32_t> firstBytes, const Scene::Impl& scene) const;
};

/// Lists valid geometry. Throws Error if an object does not exist or is named twice.
GeometryList listOf(const HostGeometry& geometry, std::span<const uint32_t> firstBytes, const Scene::Impl& scene);

}  // namespace radar
