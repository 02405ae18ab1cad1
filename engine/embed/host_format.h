// Formats of positions in a host's buffers.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

#include "radar/host.h"
#include "shaders/embed/interop.h"

namespace radar {

template <class T>
T loadAs(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

/// Checks format and stride; empty if they are valid.
std::string validate(const HostPositions& positions);
/// Bytes from the first of `count` elements to the end of the last; at most 2^62.
VkDeviceSize spanOf(VkDeviceSize stride, uint64_t count, VkDeviceSize bytes);
VkDeviceSize spanOf(const HostPositions& positions, uint32_t vertexCount);
/// Bytes from a transform's beginning to the end of its last float.
uint64_t extentOf(const TransformLayout& layout);

/// A valid format.
class HostFormat {
 public:
  explicit HostFormat(VkFormat format);
  uint32_t component() const { return component_; }  ///< gpu::kFloat32 ...
  VkDeviceSize bytes() const { return component_ == gpu::kFloat32 ? 4 : 2; }
  /// One coordinate of the position at `vertex`, with the value that deform.comp reads.
  float load(const std::byte* vertex, int axis) const;

 private:
  uint32_t component_;
};

}  // namespace radar
