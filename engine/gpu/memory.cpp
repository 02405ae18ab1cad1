#include "gpu/memory.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "gpu/api.h"

namespace radar::gpu {

namespace {

// A block is as large as all others of its memory type together, within these bounds: small users take little, large
// ones few blocks. Pieces of more than half a block are blocks of their own, as are images, which have other
// alignments.
constexpr VkDeviceSize kLeastBlock = 1u << 20, kMostBlock = 1u << 24;
// Pieces begin at multiples of it, and so does what is free.
constexpr VkDeviceSize kGrain = 256;

bool isMapped(const MemoryRequest& request) {
  return (request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
}

// A type with all required properties, and if possible all preferred ones.
uint32_t typeFor(const VkPhysicalDeviceMemoryProperties& memory, const MemoryRequest& request) {
  for (const VkMemoryPropertyFlags flags : {request.required | request.preferred, request.required}) {
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      const bool isAllowed = (request.requirements.memoryTypeBits >> i & 1) != 0;
      if (isAllowed && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
    }
  }
  throw Error(Error::Kind::device, "no memory type has the properties " + std::to_string(request.required));
}

}  // namespace

struct Allocator::Block {
  struct Range {
    VkDeviceSize first, end;
  };

  /// Takes the first free range that is large enough. Returns its beginning, or `size` of the block if there is none.
  VkDeviceSize take(VkDeviceSize bytes, VkDeviceSize alignment);
  void giveBack(VkDeviceSize first, VkDeviceSize bytes) noexcept;

  uint32_t type;
  VkDeviceSize size;
  bool isShared;  ///< else one piece takes all of it
  DeviceMemory memory;
  std::byte* mapped = nullptr;
  std::vector<Range> free;  ///< ascending, none beside another; at most one more than there are pieces
  uint32_t pieces = 0;
};

VkDeviceSize Allocator::Block::take(VkDeviceSize bytes, VkDeviceSize alignment) {
  for (auto range = free.begin(); range != free.end(); ++range) {
    const VkDeviceSize first = roundedUp(range->first, alignment);
    if (first >= range->end || range->end - first < bytes) continue;
    const Range before{range->first, first}, after{first + bytes, range->end};
    if (free.capacity() < pieces + 2) {  // giveBack() does not allocate
      const auto index = range - free.begin();
      free.reserve(2 * size_t{pieces} + 8);
      range = free.begin() + index;
    }
    ++pieces;
    if (before.first < before.end && after.first < after.end) {
      *range = before;
      free.insert(range + 1, after);
    } else if (before.first < before.end || after.first < after.end) {
      *range = before.first < before.end ? before : after;
    } else {
      free.erase(range);
    }
    return first;
  }
  return size;
}

void Allocator::Block::giveBack(VkDeviceSize first, VkDeviceSize bytes) noexcept {
  --pieces;
  const Range given{first, first + bytes};
  auto next = std::ranges::lower_bound(free, first, {}, &Range::first);
  if (next != free.begin() && std::prev(next)->end == given.first) {
    std::prev(next)->end = given.end;
    if (next != free.end() && next->first == given.end) {
      std::prev(next)->end = next->end;
      free.erase(next);
    }
  } else if (next != free.end() && next->first == given.end) {
    next->first = given.first;
  } else {
    free.insert(next, given);
  }
}

Allocator::Allocator(const Device::Impl& device) : device_(device) {}
Allocator::~Allocator() = default;

MemoryPiece Allocator::allocate(const MemoryRequest& request) {
  const std::lock_guard lock(mutex_);
  const MemoryPiece piece = device_.host.memory.allocate ? fromHost(request) : fromBlocks(request);
  use_.used += request.requirements.size;
  return piece;
}

MemoryPiece Allocator::fromHost(const MemoryRequest& request) {
  MemoryPiece piece;
  const VkDeviceSize size = request.requirements.size;
  check(device_.host.memory.allocate(request, piece), "HostMemory::allocate", request.name, size);
  const char* wrong = piece.memory == VK_NULL_HANDLE                       ? "memory"
                      : piece.offset % request.requirements.alignment != 0 ? "an aligned offset"
                      : isMapped(request) && piece.mapped == nullptr       ? "a host address"
                                                                           : nullptr;
  if (wrong != nullptr) {
    if (piece.memory != VK_NULL_HANDLE) device_.host.memory.free(piece);
    throw Error("HostMemory::allocate (" + std::string(request.name) + "): expected " + wrong + ", got none");
  }
  use_.allocated += size;
  ++use_.allocations;
  return piece;
}

void Allocator::make(Block& block, const MemoryRequest& request) const {
  const VkMemoryAllocateInfo info{
      .sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, .allocationSize = block.size, .memoryTypeIndex = block.type};
  VkDeviceMemory memory;
  check(device_.vk.AllocateMemory(device_.device(), &info, device_.host.allocator, &memory), "vkAllocateMemory",
        request.name, block.size);
  block.memory = {device_, memory};
  device_.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, memory, block.isShared ? "a block of buffers" : request.name);
  const VkMemoryPropertyFlags flags = device_.memory.memoryTypes[block.type].propertyFlags;
  if (block.isShared ? (flags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) == 0 : !isMapped(request)) return;
  void* mapped = nullptr;
  check(device_.vk.MapMemory(device_.device(), memory, 0, VK_WHOLE_SIZE, 0, &mapped), "vkMapMemory", request.name,
        block.size);
  block.mapped = static_cast<std::byte*>(mapped);
}

std::unique_ptr<Allocator::Block> Allocator::newBlock(uint32_t type, const MemoryRequest& request) const {
  VkDeviceSize all = 0;
  for (const auto& block : blocks_) all += block->type == type ? block->size : 0;
  const VkDeviceSize usual = std::clamp(std::bit_floor(all), kLeastBlock, kMostBlock);
  if (!request.isImage && request.requirements.size <= usual / 2) {
    try {
      auto block = std::make_unique<Block>(Block{.type = type, .size = usual, .isShared = true});
      block->free = {{0, usual}};
      make(*block, request);
      return block;
    } catch (const Error& error) {
      if (!isOutOfMemory(error)) throw;  // else it may suffice for the piece
    }
  }
  auto block = std::make_unique<Block>(Block{.type = type, .size = request.requirements.size, .isShared = false});
  make(*block, request);
  return block;
}

MemoryPiece Allocator::fromBlocks(const MemoryRequest& request) {
  const uint32_t type = typeFor(device_.memory, request);
  const VkDeviceSize size = roundedUp(request.requirements.size, kGrain);
  const VkDeviceSize alignment = std::max(request.requirements.alignment, kGrain);
  const auto pieceAt = [](Block& block, VkDeviceSize offset) {
    return MemoryPiece{.memory = block.memory.get(),
                       .offset = offset,
                       .mapped = block.mapped == nullptr ? nullptr : block.mapped + offset,
                       .handle = &block};
  };
  for (const auto& block : blocks_) {
    if (block->type != type || !block->isShared || request.isImage) continue;
    const VkDeviceSize offset = block->take(size, alignment);
    if (offset != block->size) return pieceAt(*block, offset);
  }
  std::unique_ptr<Block> block = newBlock(type, request);
  blocks_.reserve(blocks_.size() + 1);
  const VkDeviceSize offset = block->isShared ? block->take(size, alignment) : 0;
  use_.allocated += block->size;
  ++use_.allocations;
  blocks_.push_back(std::move(block));
  return pieceAt(*blocks_.back(), offset);
}

void Allocator::free(const MemoryPiece& piece, VkDeviceSize size) noexcept {
  const std::lock_guard lock(mutex_);
  use_.used -= size;
  const auto forget = [&](VkDeviceSize bytes) {
    use_.allocated -= bytes;
    --use_.allocations;
  };
  if (device_.host.memory.free) {
    device_.host.memory.free(piece);
    return forget(size);
  }
  auto* const block = static_cast<Block*>(piece.handle);
  if (block->isShared) {
    block->giveBack(piece.offset, roundedUp(size, kGrain));
    const auto isSpare = [&](const auto& other) {
      return other.get() != block && other->type == block->type && other->isShared && other->pieces == 0;
    };
    // One empty block is kept: what comes and goes then allocates nothing.
    if (block->pieces != 0 || std::ranges::none_of(blocks_, isSpare)) return;
  }
  forget(block->size);
  std::erase_if(blocks_, [&](const auto& other) { return other.get() == block; });
}

MemoryUse Allocator::use() const {
  const std::lock_guard lock(mutex_);
  return use_;
}

Owner Owner::counted(const Device::Impl& device) {
  Owner owner(device);
  owner.bytes_ = std::make_shared<std::atomic<uint64_t>>(0);
  return owner;
}

Memory::Memory(const Owner& owner, const MemoryRequest& request)
    : device_(&owner.device()),
      bytes_(owner.bytes_),
      piece_(device_->allocator->allocate(request)),
      size_(request.requirements.size) {
  if (bytes_ != nullptr) *bytes_ += size_;
}

Memory& Memory::operator=(Memory&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(bytes_, other.bytes_);
  std::swap(piece_, other.piece_);
  std::swap(size_, other.size_);
  return *this;
}

Memory::~Memory() {
  if (size_ == 0) return;
  if (bytes_ != nullptr) *bytes_ -= size_;
  if (!device_->abandoned) device_->allocator->free(piece_, size_);
}

}  // namespace radar::gpu
