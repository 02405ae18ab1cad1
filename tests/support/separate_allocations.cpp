#include "support/separate_allocations.h"

#include "gpu/api.h"

namespace radar::test {

HostMemory separateAllocations(const HostDevice& host) {
  gpu::Api vk(host.getInstanceProcAddr);
  vk.load(host.instance);
  vk.load(host.device);
  VkPhysicalDeviceMemoryProperties types;
  vk.GetPhysicalDeviceMemoryProperties(host.physicalDevice, &types);
  const VkDevice device = host.device;
  const auto allocate = [=](const MemoryRequest& request, MemoryPiece& piece) {
    uint32_t type = 0;
    while ((request.requirements.memoryTypeBits >> type & 1) == 0 ||
           (types.memoryTypes[type].propertyFlags & request.required) != request.required) {
      ++type;
    }
    const VkMemoryAllocateInfo info{.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                    .allocationSize = request.requirements.size,
                                    .memoryTypeIndex = type};
    VkResult result = vk.AllocateMemory(device, &info, nullptr, &piece.memory);
    if (result != VK_SUCCESS || (request.required & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) == 0) return result;
    result = vk.MapMemory(device, piece.memory, 0, VK_WHOLE_SIZE, 0, &piece.mapped);
    if (result != VK_SUCCESS) vk.FreeMemory(device, piece.memory, nullptr);
    return result;
  };
  return {.allocate = allocate,
          .free = [=](const MemoryPiece& piece) { vk.FreeMemory(device, piece.memory, nullptr); }};
}

}  // namespace radar::test
