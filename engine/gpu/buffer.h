// Buffers that grow, as bytes or as texels, and the one staging buffer through which a batch reaches the device.
#pragma once

#include <algorithm>
#include <span>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace radar::gpu {

/// Of the elements.
template <class T>
VkDeviceSize bytesOf(const std::vector<T>& v) {
  return v.size() * sizeof(T);
}

enum class Residence { device, upload, readback };

class Buffer {
 public:
  Buffer(const Device::Impl& device, const char* name, Residence residence, VkBufferUsageFlags usage);

  /// Makes the buffer hold at least `bytes`; its contents are lost if it grows. Returns whether the handle changed. The
  /// device must not be using it.
  bool reserve(VkDeviceSize bytes);

  VkBuffer get() const { return buffer_.get(); }
  const char* name() const { return name_; }
  VkDeviceSize capacity() const { return capacity_; }
  /// Unique to this VkBuffer, unlike its handle, which Vulkan may reuse.
  uint64_t identity() const { return identity_; }
  /// Host address; only where not resident on the device. Coherent.
  std::byte* mapped() const { return mapped_; }

 private:
  const Device::Impl* device_;
  const char* name_;
  Residence residence_;
  VkBufferUsageFlags usage_;
  DeviceMemory memory_;
  BufferHandle buffer_;
  VkDeviceSize capacity_ = 0;
  uint64_t identity_ = 0;
  std::byte* mapped_ = nullptr;
};

/// A buffer with a view, through which shaders read it as texels.
class TexelBuffer {
 public:
  /// `format`: R32, R32G32 or R32G32B32A32, each as UINT, SINT or SFLOAT. Every device reads these as texels; throws on
  /// any other.
  TexelBuffer(const Device::Impl& device, const char* name, Residence residence, VkBufferUsageFlags usage,
              VkFormat format);

  /// As Buffer::reserve; a new buffer has a new view. Throws Error, and changes nothing, if `bytes` are more texels
  /// than the device's maxTexelBufferElements.
  bool reserve(VkDeviceSize bytes);

  const Buffer& buffer() const { return buffer_; }
  VkBufferView view() const { return view_.get(); }
  /// Bytes that the view covers.
  VkDeviceSize capacity() const { return std::min(buffer_.capacity(), maxBytes()); }
  uint32_t texelBytes() const { return texelBytes_; }

 private:
  VkDeviceSize maxBytes() const;
  void makeView();

  const Device::Impl* device_;
  VkFormat format_;
  uint32_t texelBytes_;
  Buffer buffer_;
  BufferView view_;
};

/// Gathers copies of host data into one staging buffer, then records them as one upload.
class Upload {
 public:
  explicit Upload(const Device::Impl& device);

  /// Bytes that `add` would need room for, aligned. Call begin with the sum before the first add.
  static VkDeviceSize aligned(VkDeviceSize bytes) { return (bytes + 7) & ~VkDeviceSize{7}; }
  void begin(VkDeviceSize bytes);
  /// Copies `data` to `offset` in `target`; nothing happens for empty data.
  void add(const void* data, VkDeviceSize bytes, const Buffer& target, VkDeviceSize offset = 0);
  /// Records all copies. The caller puts the barriers.
  void record(const Commands& commands) const;

 private:
  struct Copy {
    VkBuffer target;
    VkBufferCopy region;
  };
  Buffer staging_;
  VkDeviceSize used_ = 0;
  std::vector<Copy> copies_;
};

/// A memory type with all of `needed`, and of `wanted` if there is one. Throws where there is none.
uint32_t memoryType(const Device::Impl& device, uint32_t allowed, VkMemoryPropertyFlags needed,
                    VkMemoryPropertyFlags wanted);

}  // namespace radar::gpu
