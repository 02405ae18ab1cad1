// Geometry that lies in a host's Vulkan buffers. All of them belong to the HostDevice's VkDevice and queue family, were
// made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT, and stay the host's.
#pragma once

#include <optional>
#include <span>

#include "radar/radar.h"

namespace radar {

/// Where vertices lie.
struct HostPositions {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize first = 0;    ///< bytes to the first vertex
  VkDeviceSize stride = 12;  ///< bytes from vertex to vertex
  /// Of a position: R32G32B32_SFLOAT, R16G16B16_SFLOAT, _SNORM or _UNORM, or one of those with an A that is skipped.
  /// A vertex is what a vertex shader would see; of a norm, the float next to the quotient.
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
};

/// Vertices and triangles. What wrote the buffers has been made available (a fence that was waited for is enough).
struct HostMesh {
  HostPositions positions;
  uint32_t vertexCount = 0;

  VkBuffer indices = VK_NULL_HANDLE;             ///< null: each three vertices are a triangle
  VkDeviceSize firstIndex = 0;                   ///< bytes to the first index
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;  ///< or UINT16
  uint32_t indexCount = 0;

  std::optional<Bounds> bounds;  ///< as of Scene::addMesh
};

/// Adds a copy of the mesh, read from the device once: submits to HostDevice::queue and waits, so call it while
/// loading. Throws as Scene::addMesh does, where there is no queue, for a format or an index type that is not listed,
/// for a stride shorter than a position, and where a Vulkan call fails.
RADAR_API MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh);

/// A mesh whose vertices are elsewhere now: as many as it has, each within the bounds it was added with, those that no
/// triangle uses, too.
struct DeformedMesh {
  MeshId mesh = kNone;
  HostPositions positions;
};

/// Objects that are elsewhere now: one VkTransformMatrixKHR each (3x4 floats, row-major; also how instances of
/// acceleration structures begin), in this order. The box of the object's mesh, placed by it in float arithmetic, lies
/// within Scene::setBounds, or beyond by no more than a millionth of the bounds' largest coordinate. Without
/// Device::doubles(), a mesh whose middle is farther from its own origin than that, placed, needs room within the
/// bounds instead: two millionths of that distance.
struct MovedObjects {
  VkBuffer transforms = VK_NULL_HANDLE;
  VkDeviceSize first = 0;    ///< bytes to the first transform
  VkDeviceSize stride = 48;  ///< bytes from transform to transform
  std::span<const ObjectId> objects;
};

/// What of a scene is in the host's buffers when recorded commands are executed; the rest is as the scene says.
struct HostGeometry {
  std::span<const DeformedMesh> meshes;
  std::span<const MovedObjects> objects;
};

}  // namespace radar
