#include "embed/host_transforms.h"

#include <algorithm>
#include <array>

#include "embed/host_format.h"
#include "math/float_environment.h"

namespace radar {

namespace {

std::array<float, 3> loadScales(const std::byte* at, uint32_t count) {
  std::array<float, 3> scales{1, 1, 1};
  for (size_t k = 0; k < 3 && count > 0; ++k) scales[k] = loadAs<float>(at + (count == 3 ? 4 * k : 0));
  return scales;
}

Transform read(const std::byte* bytes, const QuaternionLayout& layout) {
  std::array<float, 4> q;
  for (size_t k = 0; k < 4; ++k) q[k] = loadAs<float>(bytes + layout.quaternion + 4 * k);
  const auto [x, y, z, w] = q;
  const float twiceX = x + x, twiceY = y + y, twiceZ = z + z;
  const float xx = x * twiceX, yy = y * twiceY, zz = z * twiceZ;
  const float xy = x * twiceY, xz = x * twiceZ, yz = y * twiceZ;
  const float wx = w * twiceX, wy = w * twiceY, wz = w * twiceZ;
  const float turn[3][3] = {
      {1 - (yy + zz), xy - wz, xz + wy}, {xy + wz, 1 - (xx + zz), yz - wx}, {xz - wy, yz + wx, 1 - (xx + yy)}};
  const std::array<float, 3> scales = loadScales(bytes + layout.scale, layout.scales);
  Transform out;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 3; ++k) out.m[4 * row + k] = turn[row][k] * scales[k];
    out.m[4 * row + 3] = loadAs<float>(bytes + layout.position + 4 * row);
  }
  return out;
}

Transform read(const std::byte* bytes, const MatrixLayout& layout) {
  Transform out;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t k = 0; k < 4; ++k) {
      out.m[4 * row + k] = loadAs<float>(bytes + row * layout.row + k * layout.column);
    }
  }
  return out;
}

}  // namespace

Transform readTransform(const std::byte* bytes, const TransformLayout& layout) {
  const FloatEnvironment floats;
  return std::visit([&](const auto& known) { return read(bytes, known); }, layout);
}

std::string validate(const TransformLayout& layout) {
  const auto* turned = std::get_if<QuaternionLayout>(&layout);
  if (turned == nullptr || turned->scales == 0 || turned->scales == 1 || turned->scales == 3) return {};
  return "scales: expected 0, 1 or 3, got " + std::to_string(turned->scales);
}

uint64_t extentOf(const TransformLayout& layout) {
  if (const auto* matrix = std::get_if<MatrixLayout>(&layout)) {
    return 2 * uint64_t{matrix->row} + 3 * uint64_t{matrix->column} + 4;
  }
  const auto& turned = std::get<QuaternionLayout>(layout);
  const uint64_t end = std::max(uint64_t{turned.position} + 12, uint64_t{turned.quaternion} + 16);
  return turned.scales == 0 ? end : std::max(end, turned.scale + 4 * uint64_t{turned.scales});
}

gpu::TransformLayout encoded(const TransformLayout& layout) {
  if (const auto* matrix = std::get_if<MatrixLayout>(&layout)) {
    return {gpu::kMatrix, {matrix->row, matrix->column, 0}};
  }
  const auto& turned = std::get<QuaternionLayout>(layout);
  return {turned.scales, {turned.position, turned.quaternion, turned.scale}};
}

}  // namespace radar
