#include "radar/host.h"

#include <algorithm>
#include <numeric>

#include "embed/host_format.h"
#include "gpu/barrier.h"
#include "gpu/buffer.h"
#include "gpu/submission.h"
#include "math/float_environment.h"
#include "scene/scene.h"

namespace radar {

namespace {

void validate(const HostMesh& mesh) {
  if (std::string wrong = validate(mesh.positions); !wrong.empty()) throw Error("addMesh: positions: " + wrong);
  if (mesh.positions.buffer == VK_NULL_HANDLE) throw Error("addMesh: positions: expected a buffer");
  if (mesh.indexType != VK_INDEX_TYPE_UINT16 && mesh.indexType != VK_INDEX_TYPE_UINT32) {
    throw Error("addMesh: indexType: expected 16 or 32 bits, got VkIndexType " + std::to_string(mesh.indexType));
  }
  const uint32_t indexCount = mesh.indices == VK_NULL_HANDLE ? mesh.vertexCount : mesh.indexCount;
  if (mesh.vertexCount == 0 || indexCount == 0) throw Error("addMesh: expected at least one triangle, got none");
}

/// A mapped copy of a part of the host's buffer.
gpu::Buffer download(const Device::Impl& device, VkBuffer buffer, VkDeviceSize first, VkDeviceSize bytes) {
  gpu::Buffer readback(device, "host mesh", gpu::BufferDomain::readback, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  readback.reserve(bytes);
  gpu::Submission submission(device, false);
  const gpu::Commands commands = submission.begin();
  submission.stage("host mesh");
  const VkBufferCopy region{.srcOffset = first, .size = bytes};
  commands->CmdCopyBuffer(commands, buffer, readback.get(), 1, &region);
  gpu::copyToHost(commands);
  submission.submitAndWait();
  return readback;
}

std::vector<uint32_t> indicesOf(const Device::Impl& device, const HostMesh& mesh) {
  std::vector<uint32_t> indices(mesh.indices == VK_NULL_HANDLE ? mesh.vertexCount : mesh.indexCount);
  if (mesh.indices == VK_NULL_HANDLE) {
    std::iota(indices.begin(), indices.end(), 0u);
    return indices;
  }
  const size_t size = mesh.indexType == VK_INDEX_TYPE_UINT16 ? 2 : 4;
  const gpu::Buffer copy = download(device, mesh.indices, mesh.firstIndex, size * indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    const std::byte* at = copy.mapped() + size * i;
    indices[i] = size == 2 ? loadAs<uint16_t>(at) : loadAs<uint32_t>(at);
    if (indices[i] < mesh.vertexCount) continue;
    throw Error("addMesh: indices: triangle " + std::to_string(i / 3) + " refers to vertex " +
                std::to_string(indices[i]) + " of " + std::to_string(mesh.vertexCount));
  }
  return indices;
}

}  // namespace

MeshId addMesh(Scene& scene, const Device& device, const HostMesh& mesh) {
  const FloatEnvironment floats;
  device.impl().requireQueue("addMesh of a HostMesh");
  validate(mesh);
  std::vector<uint32_t> indices = indicesOf(device.impl(), mesh);
  const auto [least, greatest] = std::ranges::minmax(indices);
  // Where the host's vertices go; a host deforms a range of its vertices, but else only those in use matter.
  std::vector<uint32_t> places(size_t{greatest} - least + 1, mesh.bounds ? 1 : 0);
  for (const uint32_t vertex : indices) places[vertex - least] = 1;
  const HostPositions& from = mesh.positions;
  const HostFormat format(from.format);
  const gpu::Buffer copy = download(device.impl(), from.buffer, from.first + from.stride * least,
                                    spanOf(from, static_cast<uint32_t>(places.size())));
  std::vector<float> positions;
  std::vector<uint32_t> numbers;
  for (size_t v = 0; v < places.size(); ++v) {
    if (places[v] == 0) continue;
    places[v] = static_cast<uint32_t>(numbers.size());
    numbers.push_back(static_cast<uint32_t>(v));
    for (int k = 0; k < 3; ++k) positions.push_back(format.load(copy.mapped() + from.stride * v, k));
  }
  for (uint32_t& vertex : indices) vertex = places[vertex - least];
  const MeshId id = scene.addMesh(positions, indices, mesh.bounds);
  Mesh& added = scene.impl_->meshes[id];
  added.firstHostVertex = least;
  if (numbers.size() < places.size()) added.hostVertices = std::move(numbers);
  return id;
}

}  // namespace radar
