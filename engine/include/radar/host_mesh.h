// Meshes that lie in a host's Vulkan buffers.
#pragma once

#include "radar/radar.h"

namespace radar {

/// Vertices and triangles in buffers of the HostDevice's VkDevice, made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT and owned
/// by its queue family; what wrote them has been made available (a fence that was waited for is enough).
struct HostMesh {
  VkBuffer positions = VK_NULL_HANDLE;
  VkDeviceSize firstPosition = 0;  ///< bytes to the first vertex
  VkDeviceSize stride = 12;        ///< bytes from vertex to vertex
  /// Of a position: R32G32B32_SFLOAT, R16G16B16_SFLOAT, _SNORM or _UNORM, or one of those with an A that is skipped.
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
  uint32_t vertexCount = 0;

  VkBuffer indices = VK_NULL_HANDLE;             ///< null: each three vertices are a triangle
  VkDeviceSize firstIndex = 0;                   ///< bytes to the first index
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;  ///< or UINT16
  uint32_t indexCount = 0;
};

/// Adds a copy of the mesh, read from the device once: submits to HostDevice::queue and waits, so call it while
/// loading. Throws as Scene::addMesh does, where there is no queue, for a format or an index type that is not listed,
/// for a stride shorter than a position, and where a Vulkan call fails.
RADAR_API MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh);

}  // namespace radar
