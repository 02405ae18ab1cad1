#include "support/pretended_gpu.h"

#include <mutex>
#include <set>
#include <string_view>

#include "gpu/api.h"

namespace radar::test {

namespace {

// Of the driver. Those of devices are the loader's, which find the device by its handle.
PFN_vkGetDeviceProcAddr getDeviceProcAddr;
PFN_vkGetPhysicalDeviceProperties getProperties;
PFN_vkGetPhysicalDeviceMemoryProperties getMemoryProperties;
PFN_vkGetBufferMemoryRequirements getBufferRequirements;
PFN_vkGetImageMemoryRequirements getImageRequirements;
PFN_vkAllocateMemory allocate;
PFN_vkMapMemory map;

constexpr uint32_t kOfDevice = 0, kTypes = 3;
std::mutex mutex;
std::set<VkDeviceMemory> unmappable;

VKAPI_ATTR void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties* out) {
  getProperties(device, out);
  out->deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
}

VKAPI_ATTR void VKAPI_CALL memoryProperties(VkPhysicalDevice device, VkPhysicalDeviceMemoryProperties* out) {
  getMemoryProperties(device, out);
  constexpr VkMemoryPropertyFlags kHost = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  out->memoryTypeCount = kTypes;
  out->memoryTypes[kOfDevice] = {VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0};
  out->memoryTypes[1] = {kHost, 0};
  out->memoryTypes[2] = {kHost | VK_MEMORY_PROPERTY_HOST_CACHED_BIT, 0};
}

VKAPI_ATTR void VKAPI_CALL bufferRequirements(VkDevice device, VkBuffer buffer, VkMemoryRequirements* out) {
  getBufferRequirements(device, buffer, out);
  out->memoryTypeBits = (1u << kTypes) - 1;
}

VKAPI_ATTR void VKAPI_CALL imageRequirements(VkDevice device, VkImage image, VkMemoryRequirements* out) {
  getImageRequirements(device, image, out);
  out->memoryTypeBits = 1u << kOfDevice;
}

VKAPI_ATTR VkResult VKAPI_CALL allocateMemory(VkDevice device, const VkMemoryAllocateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkDeviceMemory* memory) {
  VkMemoryAllocateInfo only = *info;
  only.memoryTypeIndex = 0;  // lavapipe's
  const VkResult result = allocate(device, &only, allocator, memory);
  if (result != VK_SUCCESS) return result;
  const std::lock_guard lock(mutex);
  unmappable.erase(*memory);
  if (info->memoryTypeIndex == kOfDevice) unmappable.insert(*memory);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL mapMemory(VkDevice device, VkDeviceMemory memory, VkDeviceSize offset, VkDeviceSize size,
                                         VkMemoryMapFlags flags, void** data) {
  const std::lock_guard lock(mutex);
  return unmappable.contains(memory) ? VK_ERROR_MEMORY_MAP_FAILED : map(device, memory, offset, size, flags, data);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice device, const char* name);

// What stands for a function, which then calls the driver's; null for others.
PFN_vkVoidFunction standIn(VkInstance instance, std::string_view name) {
  const auto replace = [&](auto& driver, auto with) {
    const PFN_vkVoidFunction found = gpu::systemLoader()(instance, name.data());
    driver = reinterpret_cast<std::remove_reference_t<decltype(driver)>>(found);
    return reinterpret_cast<PFN_vkVoidFunction>(with);
  };
  if (name == "vkGetDeviceProcAddr") return replace(getDeviceProcAddr, deviceFunction);
  if (name == "vkGetPhysicalDeviceProperties") return replace(getProperties, properties);
  if (name == "vkGetPhysicalDeviceMemoryProperties") return replace(getMemoryProperties, memoryProperties);
  if (name == "vkGetBufferMemoryRequirements") return replace(getBufferRequirements, bufferRequirements);
  if (name == "vkGetImageMemoryRequirements") return replace(getImageRequirements, imageRequirements);
  if (name == "vkAllocateMemory") return replace(allocate, allocateMemory);
  if (name == "vkMapMemory") return replace(map, mapMemory);
  return nullptr;
}

VkInstance lastInstance = VK_NULL_HANDLE;

PFN_vkVoidFunction instanceFunction(VkInstance instance, const char* name) {
  const std::lock_guard lock(mutex);
  lastInstance = instance;
  const PFN_vkVoidFunction found = standIn(instance, name);
  return found != nullptr ? found : gpu::systemLoader()(instance, name);
}

PFN_vkVoidFunction deviceFunction(VkDevice device, const char* name) {
  const std::lock_guard lock(mutex);
  const PFN_vkVoidFunction found = standIn(lastInstance, name);
  return found != nullptr ? found : getDeviceProcAddr(device, name);
}

}  // namespace

HostDevice asGpu(HostDevice host) {
  host.getInstanceProcAddr = instanceFunction;
  return host;
}

}  // namespace radar::test
