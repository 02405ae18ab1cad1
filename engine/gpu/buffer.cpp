#include "gpu/buffer.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstring>
#include <utility>

#include "gpu/api.h"

namespace radar::gpu {

namespace {

constexpr VkDeviceSize kTexelBytes = 16;

BufferView viewOf(const Device::Impl& device, VkBuffer buffer, VkDeviceSize bytes, const char* name) {
  const VkBufferViewCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                    .buffer = buffer,
                                    .format = VK_FORMAT_R32G32B32A32_UINT,
                                    .range = bytes};
  return {device, info, name, bytes};
}

}  // namespace

uint64_t newIdentity() {
  static std::atomic<uint64_t> made = 0;
  return ++made;
}

Buffer::Buffer(const Owner& owner, const char* name, BufferDomain domain, VkBufferUsageFlags usage)
    : owner_(owner), name_(name), domain_(domain), usage_(usage) {}

VkDeviceSize Buffer::sizeFor(VkDeviceSize bytes) const {
  const Device::Impl& device = owner_.device();
  VkDeviceSize most = device.maxBufferBytes;
  if ((usage_ & kAsTexels) != 0) {
    // Shaders index texels by an int.
    const uint64_t texels = std::min<uint64_t>(device.properties.limits.maxTexelBufferElements, INT32_MAX);
    if (bytes > texels * kTexelBytes) {
      throw LimitError(std::string(name_) + ": " + std::to_string((bytes + kTexelBytes - 1) / kTexelBytes) +
                       " texels, but the device's maxTexelBufferElements is " + std::to_string(texels));
    }
    most = std::min(most / kTexelBytes, texels) * kTexelBytes;
  }
  if (bytes > device.maxBufferBytes) {
    throw LimitError(std::string(name_) + ": " + std::to_string(bytes) + " bytes, but the device's maxBufferSize is " +
                     std::to_string(device.maxBufferBytes));
  }
  // Little more than is needed; but a buffer that grows a little each time grows by half, so that it is seldom made and
  // filled anew.
  VkDeviceSize wanted = roundedUp(std::max({bytes + bytes / 64, capacity_ + capacity_ / 2, VkDeviceSize{1}}), 256);
  // An odd number of times 256: lavapipe compiles a kernel anew for a texel buffer whose size is a power of two or a
  // multiple of 64 KiB, if its sizes were neither before, and the other way round.
  if ((usage_ & kAsTexels) != 0) wanted = roundedUp(wanted, 512) + 256;
  return std::min(wanted, most);
}

bool Buffer::reserve(VkDeviceSize bytes) {
  if (bytes <= capacity_ && capacity_ != 0) return false;
  const Device::Impl& device = owner_.device();
  const VkDeviceSize size = sizeFor(bytes);
  const VkBufferCreateInfo info{.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = size, .usage = usage_};
  Memory memory;  // outlives the buffer in it, old or new
  BufferHandle buffer(device, info, name_, size);
  MemoryRequest request{.name = name_};
  device.vk.GetBufferMemoryRequirements(device.device(), buffer.get(), &request.requirements);
  if (domain_ == BufferDomain::device) {
    request.preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  } else {
    request.required = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    if (domain_ == BufferDomain::readback) request.preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  }
  memory = Memory(owner_, request);
  check(device.vk.BindBufferMemory(device.device(), buffer.get(), memory.get(), memory.offset()), "vkBindBufferMemory",
        name_, size);
  BufferView view;
  if ((usage_ & kAsTexels) != 0) view = viewOf(device, buffer.get(), size, name_);
  view_ = std::move(view);
  buffer_ = std::move(buffer);
  memory_ = std::move(memory);
  capacity_ = size;
  identity_ = newIdentity();
  return true;
}

Upload::Upload(const Owner& owner) : owner_(owner) {}

void Upload::begin() {
  current_ = 0;
  used_ = 0;
  regions_.clear();
  runs_.clear();
}

void Upload::reserve(VkDeviceSize bytes) {
  for (; current_ < blocks_.size(); ++current_, used_ = 0) {
    if (used_ + bytes <= blocks_[current_].capacity()) return;
  }
  VkDeviceSize all = 0;
  for (const Buffer& block : blocks_) all += block.capacity();
  // As large as all others together, so that there are few.
  Buffer block(owner_, "staging", BufferDomain::upload, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  block.reserve(std::max(bytes, std::min(all, owner_.device().maxBufferBytes)));
  blocks_.push_back(std::move(block));
}

void Upload::add(const void* data, VkDeviceSize bytes, const Buffer& target, VkDeviceSize offset) {
  if (bytes != 0) std::memcpy(place(bytes, target, offset), data, bytes);
}

std::byte* Upload::place(VkDeviceSize bytes, const Buffer& target, VkDeviceSize offset) {
  assert(offset + bytes <= target.capacity());
  reserve(bytes);
  const Buffer& block = blocks_[current_];
  const VkDeviceSize at = std::exchange(used_, roundedUp(used_ + bytes, 8));
  const bool continues = !runs_.empty() && runs_.back().from == block.get() && runs_.back().to == target.get();
  if (continues && regions_.back().srcOffset + regions_.back().size == at &&
      regions_.back().dstOffset + regions_.back().size == offset) {
    regions_.back().size += bytes;
  } else {
    regions_.push_back({at, offset, bytes});
    if (!continues) runs_.push_back({block.get(), target.get(), 0});
    runs_.back().end = static_cast<uint32_t>(regions_.size());
  }
  return block.mapped() + at;
}

VkDeviceSize Upload::bytes() const {
  VkDeviceSize bytes = 0;
  for (const VkBufferCopy& region : regions_) bytes += region.size;
  return bytes;
}

void Upload::record(const Commands& commands) const {
  uint32_t first = 0;
  for (const Run& run : runs_) {
    commands->CmdCopyBuffer(commands, run.from, run.to, run.end - first, &regions_[first]);
    first = run.end;
  }
}

}  // namespace radar::gpu
