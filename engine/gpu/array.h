// Buffers with an element type, for the typed slots of kernels (gpu/kernel.h).
#pragma once

#include <type_traits>

#include "gpu/buffer.h"

namespace radar::gpu {

/// Elements that shaders read and write as a storage buffer or, with the usage kAsTexels, read as one or more texels
/// each.
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

}  // namespace radar::gpu
