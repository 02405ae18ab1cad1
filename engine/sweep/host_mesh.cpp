#include "radar/host_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"

namespace radar {

namespace {

enum class Component { float32, float16, snorm16, unorm16 };

/// Three of what, one behind the other; what may follow is skipped.
std::optional<Component> componentOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32G32B32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return Component::float32;
    case VK_FORMAT_R16G16B16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return Component::float16;
    case VK_FORMAT_R16G16B16_SNORM:
    case VK_FORMAT_R16G16B16A16_SNORM:
      return Component::snorm16;
    case VK_FORMAT_R16G16B16_UNORM:
    case VK_FORMAT_R16G16B16A16_UNORM:
      return Component::unorm16;
    default:
      return std::nullopt;
  }
}

VkDeviceSize bytesOf(Component component) {
  return component == Component::float32 ? 4 : 2;
}

template <class T>
T loadAs(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

float fromHalf(uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float sign = (bits & 0x8000) != 0 ? -1.0f : 1.0f;
  if (exponent == 31) return fraction == 0 ? sign * INFINITY : NAN;
  return sign * std::ldexp(static_cast<float>(exponent == 0 ? fraction : fraction + 1024), std::max(exponent, 1) - 25);
}

/// As Vulkan converts it for a vertex shader.
float load(Component component, const std::byte* at) {
  switch (component) {
    case Component::float32:
      return loadAs<float>(at);
    case Component::float16:
      return fromHalf(loadAs<uint16_t>(at));
    case Component::snorm16:
      return std::max(static_cast<float>(loadAs<int16_t>(at)) / 32767.0f, -1.0f);
    case Component::unorm16:
      return static_cast<float>(loadAs<uint16_t>(at)) / 65535.0f;
  }
  return NAN;
}

struct Range {
  VkBuffer buffer;
  VkDeviceSize first, bytes;
};

/// The ranges' bytes, one behind the other.
std::vector<std::byte> download(const Device::Impl& device, const std::vector<Range>& ranges) {
  VkDeviceSize total = 0;
  for (const Range& range : ranges) total += range.bytes;
  gpu::Buffer readback(device, "host mesh", gpu::Residence::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  readback.reserve(total);
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  submission.stage("host mesh");
  VkDeviceSize at = 0;
  for (const Range& range : ranges) {
    const VkBufferCopy copy{range.first, at, range.bytes};
    commands->CmdCopyBuffer(commands, range.buffer, readback.get(), 1, &copy);
    at += range.bytes;
  }
  gpu::copyToHost(commands);
  submission.submitAndWait();
  return {readback.mapped(), readback.mapped() + total};
}

}  // namespace

MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh) {
  device.impl().requireQueue("addMesh of a HostMesh");
  const auto component = componentOf(mesh.format);
  if (!component) {
    throw Error(
        "HostMesh::format: expected three or four components of 32-bit float, or of 16-bit float, snorm or "
        "unorm, got VkFormat " +
        std::to_string(mesh.format));
  }
  const VkDeviceSize size = bytesOf(*component), indexSize = mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
  if (mesh.stride < 3 * size) {
    throw Error("HostMesh::stride: expected at least " + std::to_string(3 * size) + " bytes, got " +
                std::to_string(mesh.stride));
  }
  if (mesh.indexType != VK_INDEX_TYPE_UINT16 && mesh.indexType != VK_INDEX_TYPE_UINT32) {
    throw Error("HostMesh::indexType: expected 16 or 32 bits, got VkIndexType " + std::to_string(mesh.indexType));
  }
  const uint32_t indexCount = mesh.indices == VK_NULL_HANDLE ? mesh.vertexCount : mesh.indexCount;
  if (mesh.vertexCount == 0 || indexCount == 0) throw Error("HostMesh: expected at least one triangle, got none");

  std::vector<Range> ranges{{mesh.positions, mesh.firstPosition, mesh.stride * (mesh.vertexCount - 1) + 3 * size}};
  if (mesh.indices != VK_NULL_HANDLE) ranges.push_back({mesh.indices, mesh.firstIndex, indexSize * indexCount});
  const std::vector<std::byte> bytes = download(device.impl(), ranges);
  std::vector<float> positions;
  for (VkDeviceSize v = 0; v < mesh.vertexCount; ++v) {
    for (int k = 0; k < 3; ++k) positions.push_back(load(*component, &bytes[mesh.stride * v + k * size]));
  }
  std::vector<uint32_t> indices(indexCount);
  for (uint32_t i = 0; i < indexCount; ++i) {
    if (mesh.indices == VK_NULL_HANDLE) {
      indices[i] = i;
    } else {
      const std::byte* at = &bytes[ranges[0].bytes + indexSize * i];
      indices[i] = indexSize == 2 ? loadAs<uint16_t>(at) : loadAs<uint32_t>(at);
    }
  }
  return scene.addMesh(positions, indices);
}

}  // namespace radar
