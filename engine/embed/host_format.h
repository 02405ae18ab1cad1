// How a host's buffers hold positions.
#pragma once

#include <cstddef>
#include <cstring>
#include <string>

#include "radar/host_geometry.h"
#include "shaders/interop.h"

namespace radar {

template <class T>
T loadAs(const std::byte* at) {
  T value;
  std::memcpy(&value, at, sizeof(T));
  return value;
}

/// Format and stride; empty if nothing is.
std::string whatIsWrong(const HostPositions& positions);
/// Bytes from the first of `count` elements to the end of the last; 2^62 where there are more.
VkDeviceSize spanOf(VkDeviceSize stride, uint64_t count, VkDeviceSize bytes);
VkDeviceSize spanOf(const HostPositions& positions, uint32_t vertexCount);

/// A format that is not wrong.
class HostFormat {
 public:
  explicit HostFormat(VkFormat format);
  uint32_t component() const { return component_; }  ///< gpu::kFloat32 ...
  VkDeviceSize bytes() const { return component_ == gpu::kFloat32 ? 4 : 2; }
  /// A coordinate of the position at `vertex`, as deform.comp reads it.
  float load(const std::byte* vertex, int axis) const;

 private:
  uint32_t component_;
};

}  // namespace radar
