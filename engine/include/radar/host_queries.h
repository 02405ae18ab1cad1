// Queries that a host's shaders write.
#pragma once

#include "radar/device.h"

namespace radar {

/// A query of mode contact in a host's buffer; radar/query.glsl declares it for shaders. Its floats are taken as exact
/// numbers. Members are those of Query; what is missing here, only a Query offers.
///
/// It is not answered, but Status::invalid with Flag::query, if a number is not finite, the direction is 0, the
/// distance negative, the mesh not one of the scene when recording, or another flag set. A singular matrix flattens the
/// mesh.
struct HostQuery {
  float worldFromMesh[12]{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< rows (m0 m1 m2 t)
  float direction[3]{};
  float distance = 0;
  MeshId mesh = kNone;
  uint32_t mask = ~0u;
  ObjectId exclude = kNone;  ///< an object to ignore, such as the sensor's own; kNone, or no object: none
  uint32_t flags = 0;        ///< kAnyHit, or 0
  static constexpr uint32_t kAnyHit = 1;
};
static_assert(sizeof(HostQuery) == 80);

/// Buffers with queries. They belong to the HostDevice's VkDevice and queue family, have the usage
/// VK_BUFFER_USAGE_TRANSFER_SRC_BIT, and remain the host's.
struct HostQueries {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize first = 0;                   ///< offset of the first query, bytes
  VkDeviceSize stride = sizeof(HostQuery);  ///< distance between queries, bytes
  /// The number of queries, or, with `countBuffer`, the most that count; at most Capacity::queries. The buffer has room
  /// for so many.
  uint32_t count = 0;
  VkBuffer countBuffer = VK_NULL_HANDLE;  ///< null, or has the number of queries, a uint32_t
  VkDeviceSize countOffset = 0;           ///< of that number, bytes
};

}  // namespace radar
