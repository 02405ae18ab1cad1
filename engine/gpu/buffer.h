// Growable buffers, also typed or as texels, and the staging buffers that upload a batch.
#pragma once

#include <algorithm>
#include <span>
#include <type_traits>
#include <vector>

#include "gpu/memory.h"

namespace radar::gpu {

/// Size of the elements.
template <class T, class Allocator>
VkDeviceSize bytesOf(const std::vector<T, Allocator>& v) {
  return v.size() * sizeof(T);
}

/// A number that nothing else has: unlike handles, which Vulkan may reuse.
uint64_t newIdentity();

enum class BufferDomain { device, upload, readback };

/// A usage: shaders may read the buffer through a view (`utextureBuffer`), as texels of four integers. Not as floats,
/// since a device may change the bits of subnormal floats and NaNs.
inline constexpr VkBufferUsageFlags kAsTexels = VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;

class Buffer {
 public:
  Buffer(const Owner& owner, const char* name, BufferDomain domain, VkBufferUsageFlags usage);

  /// Makes the buffer hold at least `bytes`, and at most half as many more; growing loses the contents. Even if `bytes`
  /// are 0, get() then is a buffer. Returns whether the handle changed. The device must not be using it. Throws Error,
  /// and changes nothing, if `bytes` exceed the device's maxBufferSize or, as texels, maxTexelBufferElements.
  bool reserve(VkDeviceSize bytes);

  VkBuffer get() const { return buffer_.get(); }
  const char* name() const { return name_; }
  VkDeviceSize capacity() const { return capacity_; }
  /// Of all of it; null unless kAsTexels.
  VkBufferView view() const { return view_.get(); }
  /// A newIdentity() of the VkBuffer.
  uint64_t identity() const { return identity_; }
  /// Host address, unless resident on the device. Coherent.
  std::byte* mapped() const { return memory_.mapped(); }

 private:
  /// Of a buffer that has room for `bytes`, and some to spare.
  VkDeviceSize sizeFor(VkDeviceSize bytes) const;

  Owner owner_;
  const char* name_;
  BufferDomain domain_;
  VkBufferUsageFlags usage_;
  Memory memory_;
  BufferHandle buffer_;
  BufferView view_;
  VkDeviceSize capacity_ = 0;
  uint64_t identity_ = 0;
};

/// A buffer with an element type, for the typed slots of kernels (gpu/kernel.h). Shaders read and write its elements as
/// a storage buffer or, with the usage kAsTexels, read each as one or more texels.
template <class T>
class Array {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  /// `usage`: in addition to STORAGE_BUFFER.
  Array(const Owner& owner, const char* name, BufferDomain domain, VkBufferUsageFlags usage = 0)
      : buffer_(owner, name, domain, usage | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {}

  /// Makes room for at least `count` elements; growing loses the contents. Returns whether it grew. The device must not
  /// be using it.
  bool reserve(VkDeviceSize count) { return buffer_.reserve(count * sizeof(T)); }

  /// In elements.
  VkDeviceSize capacity() const { return buffer_.capacity() / sizeof(T); }
  /// Size of the buffer, at least that of `capacity()` elements.
  VkDeviceSize bytes() const { return buffer_.capacity(); }
  VkBuffer get() const { return buffer_.get(); }
  /// Host address, unless resident on the device. Coherent.
  T* mapped() const { return reinterpret_cast<T*>(buffer_.mapped()); }

  VkBufferView view() const { return buffer_.view(); }
  const Buffer& buffer() const { return buffer_; }
  /// For uploads, copies and indirect dispatches.
  operator const Buffer&() const { return buffer_; }

 private:
  Buffer buffer_;
};

/// Gathers copies of host data in staging buffers that it keeps, then records them as one upload.
class Upload {
 public:
  explicit Upload(const Owner& owner);

  /// Forgets what was gathered, and keeps the memory, which the device must not be using.
  void begin();
  /// Makes room: pieces placed next, of up to `bytes` in all (each rounded up to a multiple of 8), need no more memory
  /// and lie one behind the other.
  void reserve(VkDeviceSize bytes);
  /// Copies `data` to `offset` in `target`; does nothing for empty data.
  void add(const void* data, VkDeviceSize bytes, const Buffer& target, VkDeviceSize offset = 0);
  /// The same for data that the caller then writes where this returns.
  std::byte* place(VkDeviceSize bytes, const Buffer& target, VkDeviceSize offset);
  /// What was gathered, in bytes.
  VkDeviceSize bytes() const;
  /// Records all copies; allocates nothing. The caller records the barriers.
  void record(const Commands& commands) const;

 private:
  /// Copies from one block to one target, which end before region `end`.
  struct Run {
    VkBuffer from, to;
    uint32_t end;
  };

  Owner owner_;
  std::vector<Buffer> blocks_;
  size_t current_ = 0;     ///< block for the next piece, if it has room
  VkDeviceSize used_ = 0;  ///< of the current block
  std::vector<VkBufferCopy> regions_;
  std::vector<Run> runs_;
};

}  // namespace radar::gpu
