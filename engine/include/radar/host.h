// What the engine reads from a host's Vulkan buffers: meshes, once, while loading (addMesh); and when the commands of a
// Recorder (recorder.h) execute, geometry that moves or deforms (HostGeometry) and queries that shaders write
// (HostQueries).
//
// All buffers belong to the HostDevice's VkDevice and queue family, have the usage kHostBufferUsage, and remain the
// host's.
#pragma once

#include <optional>
#include <span>

#include "radar/device.h"

namespace radar {

inline constexpr VkBufferUsageFlags kHostBufferUsage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

/// Vertex positions in a buffer.
struct HostPositions {
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceSize first = 0;    ///< offset of the first vertex, bytes
  VkDeviceSize stride = 12;  ///< distance between vertices, bytes
  /// R32G32B32_SFLOAT, R16G16B16_SFLOAT, _SNORM or _UNORM, or one of those with an A component, which is ignored.
  /// Values are those that a vertex shader reads; a normalised value is the float nearest to the quotient.
  VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
};

/// Vertices and a list of triangles (VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST, without primitive restart); strips and fans
/// are not read. Writes to the buffers have been made available (waiting for a fence suffices).
struct HostMesh {
  HostPositions positions{};
  uint32_t vertexCount = 0;

  VkBuffer indices = VK_NULL_HANDLE;             ///< null: every three vertices are a triangle
  VkDeviceSize firstIndex = 0;                   ///< offset of the first index, bytes
  VkIndexType indexType = VK_INDEX_TYPE_UINT32;  ///< or UINT16
  uint32_t indexCount = 0;

  std::optional<Bounds> bounds{};  ///< see Scene::addMesh
};

/// Adds a copy of the mesh, read from the device once: of the vertices those that a triangle uses, in their order, or,
/// with `bounds`, all from the first to the last of those. So meshes may share one buffer. Submits to HostDevice::queue
/// and waits, so call it while loading. Throws as Scene::addMesh does, and if there is no queue, a format or index type
/// is not listed, a stride is shorter than a position, or a Vulkan call fails.
RADAR_API MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh);

/// New vertex positions of a mesh, numbered as its indices were. Those that addMesh kept are read, each of which is
/// finite, at most 2^120, and within the bounds given to it, if any. Without bounds, those that triangles use may be
/// anywhere: the device bounds them.
struct DeformedMesh {
  MeshId mesh = kNone;
  HostPositions positions{};
};

/// How a matrix of floats lies in memory: its entry in row i and column k is `i * row + k * column` bytes from its
/// beginning; column 3 is the position. The last row of a 4x4 matrix is not read.
struct TransformLayout {
  uint32_t row = 16;
  uint32_t column = 4;
  bool operator==(const TransformLayout&) const = default;
};
inline constexpr TransformLayout kRowMajor{16, 4};     ///< VkTransformMatrixKHR, or a 4x4 matrix by rows
inline constexpr TransformLayout kColumnMajor{4, 16};  ///< a 4x4 matrix by columns, such as GLSL's mat4

/// New transforms of objects, one each: of those listed, in this order, or of `count` objects from `firstObject` on.
/// Coordinates are at most 2^80; the device fits the tree over objects to them. An object with Scene::setBounds stays
/// within those: its mesh's box, in float arithmetic, exceeds them by at most a millionth of their largest coordinate.
///
/// A shader that adds an answer to a place rounds the sum, so that the object may touch what it was free of. The sum is
/// exact if both are multiples of one power of two, of which it is at most 2^24 times.
struct MovedObjects {
  VkBuffer transforms = VK_NULL_HANDLE;
  VkDeviceSize first = 0;    ///< offset of the first transform, bytes
  VkDeviceSize stride = 48;  ///< distance between transforms, bytes; at least a transform's extent
  std::span<const ObjectId> objects{};
  ObjectId firstObject = 0;
  uint32_t count = 0;  ///< 0 with a list
  TransformLayout layout = kRowMajor;
};

/// The geometry that recorded commands read from the host's buffers when they execute. Everything else comes from the
/// scene.
struct HostGeometry {
  std::span<const DeformedMesh> meshes{};
  std::span<const MovedObjects> objects{};
};

/// A query of mode contact in a host's buffer; radar/query.glsl declares it for shaders. Its floats are taken as exact
/// numbers. Members are those of Query; what is missing here, only a Query offers.
///
/// It is not answered, but Status::invalid with Flag::query, if a number is not finite, the direction is 0, the
/// distance negative, the mesh not one of the scene when recording, or another flag set. A singular matrix flattens the
/// mesh.
struct HostQuery {
  float worldFromMesh[12]{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};  ///< rows (m0 m1 m2 t)
  float direction[3]{};
  float distance = 0;  ///< a host that rounds its D to a float asks about the rounded one
  MeshId mesh = kNone;
  uint32_t mask = ~0u;
  ObjectId exclude = kNone;  ///< an object to ignore, such as the sensor's own; kNone, or no object: none
  uint32_t flags = 0;        ///< kAnyHit, or 0
  static constexpr uint32_t kAnyHit = 1;
};
static_assert(sizeof(HostQuery) == 80);

/// Queries in a buffer.
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
