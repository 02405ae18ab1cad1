#include "radar/host_geometry.h"

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"

namespace radar {

namespace {

struct Range {
  VkBuffer buffer;
  VkDeviceSize first, bytes;
};

/// Reads the ranges' bytes, concatenated.
std::vector<std::byte> download(const Device::Impl& device, const std::vector<Range>& ranges) {
  VkDeviceSize total = 0;
  for (const Range& range : ranges) total += range.bytes;
  gpu::Buffer readback(device, "host mesh", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
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
  if (std::string wrong = validate(mesh.positions); !wrong.empty()) throw Error("addMesh: positions: " + wrong);
  if (mesh.positions.buffer == VK_NULL_HANDLE) throw Error("addMesh: positions: expected a buffer");
  const HostFormat format(mesh.positions.format);
  const VkDeviceSize indexSize = mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
  if (mesh.indexType != VK_INDEX_TYPE_UINT16 && mesh.indexType != VK_INDEX_TYPE_UINT32) {
    throw Error("addMesh: indexType: expected 16 or 32 bits, got VkIndexType " + std::to_string(mesh.indexType));
  }
  const uint32_t indexCount = mesh.indices == VK_NULL_HANDLE ? mesh.vertexCount : mesh.indexCount;
  if (mesh.vertexCount == 0 || indexCount == 0) throw Error("addMesh: expected at least one triangle, got none");

  std::vector<Range> ranges{{mesh.positions.buffer, mesh.positions.first, spanOf(mesh.positions, mesh.vertexCount)}};
  if (mesh.indices != VK_NULL_HANDLE) ranges.push_back({mesh.indices, mesh.firstIndex, indexSize * indexCount});
  const std::vector<std::byte> bytes = download(device.impl(), ranges);
  std::vector<float> positions;
  for (VkDeviceSize v = 0; v < mesh.vertexCount; ++v) {
    for (int k = 0; k < 3; ++k) positions.push_back(format.load(&bytes[mesh.positions.stride * v], k));
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
  return scene.addMesh(positions, indices, mesh.bounds);
}

}  // namespace radar
