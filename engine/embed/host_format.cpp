#include "embed/host_format.h"

#include <algorithm>
#include <cmath>

namespace radar {

namespace {

uint32_t componentOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32G32B32_SFLOAT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return gpu::kFloat32;
    case VK_FORMAT_R16G16B16_SFLOAT:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return gpu::kFloat16;
    case VK_FORMAT_R16G16B16_SNORM:
    case VK_FORMAT_R16G16B16A16_SNORM:
      return gpu::kSnorm16;
    case VK_FORMAT_R16G16B16_UNORM:
    case VK_FORMAT_R16G16B16A16_UNORM:
      return gpu::kUnorm16;
    default:
      return gpu::kNobody;
  }
}

float fromHalf(uint16_t bits) {
  const int exponent = bits >> 10 & 31, fraction = bits & 1023;
  const float sign = (bits & 0x8000) != 0 ? -1.0f : 1.0f;
  if (exponent == 31) return fraction == 0 ? sign * INFINITY : NAN;
  return sign * std::ldexp(static_cast<float>(exponent == 0 ? fraction : fraction + 1024), std::max(exponent, 1) - 25);
}

}  // namespace

std::string validate(const HostPositions& positions) {
  if (componentOf(positions.format) == gpu::kNobody) {
    return "format: expected three or four components of 32-bit float, or of 16-bit float, snorm or unorm, got "
           "VkFormat " +
           std::to_string(positions.format);
  }
  const VkDeviceSize least = 3 * HostFormat(positions.format).bytes();
  if (positions.stride >= least) return {};
  return "stride: expected at least " + std::to_string(least) + " bytes, got " + std::to_string(positions.stride);
}

VkDeviceSize spanOf(VkDeviceSize stride, uint64_t count, VkDeviceSize bytes) {
  constexpr VkDeviceSize kMost = VkDeviceSize{1} << 62;
  if (count > 1 && stride > (kMost - bytes) / (count - 1)) return kMost;
  return stride * (count - 1) + bytes;
}

VkDeviceSize spanOf(const HostPositions& positions, uint32_t vertexCount) {
  return spanOf(positions.stride, vertexCount, 3 * HostFormat(positions.format).bytes());
}

uint64_t extentOf(const TransformLayout& layout) {
  return 2 * uint64_t{layout.row} + 3 * uint64_t{layout.column} + 4;
}

HostFormat::HostFormat(VkFormat format) : component_(componentOf(format)) {}

float HostFormat::load(const std::byte* vertex, int axis) const {
  const std::byte* at = vertex + bytes() * static_cast<size_t>(axis);
  switch (component_) {
    case gpu::kFloat32:
      return loadAs<float>(at);
    case gpu::kFloat16:
      return fromHalf(loadAs<uint16_t>(at));
    case gpu::kSnorm16:
      return std::max(static_cast<float>(loadAs<int16_t>(at)) / 32767.0f, -1.0f);
    default:
      return static_cast<float>(loadAs<uint16_t>(at)) / 65535.0f;
  }
}

}  // namespace radar
