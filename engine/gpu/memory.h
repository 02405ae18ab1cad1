// Device memory: buffers and images take pieces of a few blocks, or a host's allocator gives each.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "gpu/device.h"

namespace radar::gpu {

constexpr VkDeviceSize roundedUp(VkDeviceSize n, VkDeviceSize step) {
  return (n + step - 1) / step * step;
}

/// A device's memory. Any thread may use it.
class Allocator {
 public:
  explicit Allocator(const Device::Impl& device);
  ~Allocator();

  /// Throws Error if memory does not suffice. MemoryPiece::handle is its own, unless the host allocates.
  MemoryPiece allocate(const MemoryRequest& request);
  /// `size`: of the request.
  void free(const MemoryPiece& piece, VkDeviceSize size) noexcept;
  MemoryUse use() const;

 private:
  struct Block;
  MemoryPiece fromHost(const MemoryRequest& request);
  MemoryPiece fromBlocks(const MemoryRequest& request);
  std::unique_ptr<Block> newBlock(uint32_t type, const MemoryRequest& request) const;
  void make(Block& block, const MemoryRequest& request) const;

  const Device::Impl& device_;
  mutable std::mutex mutex_;
  std::vector<std::unique_ptr<Block>> blocks_;
  MemoryUse use_;
};

/// What buffers and images are made for: a device, and a count of the memory that one object, such as a Recorder, holds
/// there.
class Owner {
 public:
  /// Of whom nobody asks how much memory it holds.
  Owner(const Device::Impl& device) : device_(&device) {}
  static Owner counted(const Device::Impl& device);

  const Device::Impl& device() const { return *device_; }
  operator const Device::Impl&() const { return *device_; }
  uint64_t bytes() const { return *bytes_; }

 private:
  friend class Memory;
  const Device::Impl* device_;
  std::shared_ptr<std::atomic<uint64_t>> bytes_;  ///< null: not counted
};

/// One piece, until it is destroyed.
class Memory {
 public:
  Memory() = default;
  Memory(const Owner& owner, const MemoryRequest& request);
  Memory(Memory&& other) noexcept { *this = std::move(other); }
  Memory& operator=(Memory&& other) noexcept;
  ~Memory();

  VkDeviceMemory get() const { return piece_.memory; }
  VkDeviceSize offset() const { return piece_.offset; }
  /// Null unless VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT was required.
  std::byte* mapped() const { return static_cast<std::byte*>(piece_.mapped); }

 private:
  const Device::Impl* device_ = nullptr;
  std::shared_ptr<std::atomic<uint64_t>> bytes_;
  MemoryPiece piece_;
  VkDeviceSize size_ = 0;
};

}  // namespace radar::gpu
