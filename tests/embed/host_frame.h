// What a host moves and deforms.
#pragma once

#include <deque>

#include "embed/on_device.h"

namespace radar::test {

/// What a host moves and deforms in a frame, in buffers of its own.
class HostFrame {
 public:
  explicit HostFrame(const Device& on = test::device()) : device_(&on) {}

  /// The mesh's vertices, which lie somewhere else in each buffer.
  HostFrame& deform(MeshId mesh, std::span<const float> positions) {
    const size_t first = 3 * deformed_.size() % 8, stride = 12 + deformed_.size() % 9;
    std::vector<std::byte> bytes(first + stride * (positions.size() / 3) + 12);
    for (size_t v = 0; v < positions.size() / 3; ++v) std::memcpy(&bytes[first + stride * v], &positions[3 * v], 12);
    vertices_.emplace_back(bytes, *device_);
    deformed_.push_back({mesh, {.buffer = vertices_.back().get(), .first = first, .stride = stride}});
    return *this;
  }
  HostFrame& move(ObjectId object, const Transform& worldFromMesh) {
    bytes_.resize(kFirst + kStride * moved_.size());
    for (const double entry : worldFromMesh.m) append(bytes_, {static_cast<float>(entry)});
    moved_.push_back(object);
    return *this;
  }
  /// For as long as the frame lives.
  HostGeometry geometry() {
    if (moved_.empty()) return {.meshes = deformed_};
    transforms_.emplace_back(bytes_, *device_);
    group_ = {.transforms = transforms_.back().get(), .first = kFirst, .stride = kStride, .objects = moved_};
    return {.meshes = deformed_, .objects = {&group_, 1}};
  }

 private:
  static constexpr size_t kFirst = 16, kStride = 64;
  const Device* device_;
  std::deque<OnDevice> vertices_, transforms_;
  std::vector<std::byte> bytes_;
  std::vector<DeformedMesh> deformed_;
  std::vector<ObjectId> moved_;
  MovedObjects group_;
};

}  // namespace radar::test
