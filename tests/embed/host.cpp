#include "embed/host.h"

#include <malloc.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <vector>

#include <vulkan/vulkan.h>

#include "support/separate_allocations.h"
#include "support/test_device.h"
#include "support/watched_vulkan.h"

namespace radar::test {

namespace {

std::atomic<int64_t> allocated, live;

void require(VkResult result, const char* call) {
  if (result != VK_SUCCESS) throw Error(std::string("the host's ") + call + " failed", result);
}

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void*) {
  onValidation(data->pMessageIdName + std::string(": ") + data->pMessage);
  return VK_FALSE;
}

VKAPI_ATTR void* VKAPI_CALL allocate(void*, size_t size, size_t alignment, VkSystemAllocationScope) {
  const size_t step = std::max(alignment, alignof(std::max_align_t));
  void* memory = std::aligned_alloc(step, (size + step - 1) / step * step);
  allocated += memory == nullptr ? 0 : 1;
  live += memory == nullptr ? 0 : 1;
  return memory;
}

VKAPI_ATTR void VKAPI_CALL release(void*, void* memory) {
  live -= memory == nullptr ? 0 : 1;
  std::free(memory);
}

VKAPI_ATTR void* VKAPI_CALL reallocate(void* user, void* memory, size_t size, size_t alignment,
                                       VkSystemAllocationScope scope) {
  void* moved = size == 0 ? nullptr : allocate(user, size, alignment, scope);
  if (memory != nullptr && moved != nullptr) std::memcpy(moved, memory, std::min(malloc_usable_size(memory), size));
  if (size == 0 || moved != nullptr) release(user, memory);
  return moved;
}

}  // namespace

Host::Host(Mode mode, uint32_t index) {
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = onMessage};
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO, .apiVersion = VK_API_VERSION_1_3};
  const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
  const VkInstanceCreateInfo instanceInfo{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                          .pNext = &messenger,
                                          .pApplicationInfo = &application,
                                          .enabledExtensionCount = 1,
                                          .ppEnabledExtensionNames = &extension};
  require(vkCreateInstance(&instanceInfo, nullptr, &handles.instance), "vkCreateInstance");
  const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(handles.instance, "vkCreateDebugUtilsMessengerEXT"));
  require(create(handles.instance, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
  uint32_t count = 0;
  require(vkEnumeratePhysicalDevices(handles.instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> all(count);
  require(vkEnumeratePhysicalDevices(handles.instance, &count, all.data()), "vkEnumeratePhysicalDevices");
  std::erase_if(all, [](VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    return !isTested(properties.deviceName);
  });
  if (all.empty()) throw Error("the host finds none of the tested devices");
  handles = hostOf(handles.instance, all[index % all.size()]);
  handles.doubles = handles.doubles && wantsDoubles();
  handles.sampled = handles.sampled && mode == Mode::sampled;
  handles.debugNames = true;
  handles.getInstanceProcAddr = watchedLoader();
  const float priority = 1;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = handles.queueFamily,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  Requirements needed = requirements(handles);
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = needed.chain(),
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue};
  require(vkCreateDevice(handles.physicalDevice, &info, nullptr, &handles.device), "vkCreateDevice");
  vkGetDeviceQueue(handles.device, handles.queueFamily, 0, &handles.queue);
  handles.memory = separateAllocations(handles);
}

HostDevice Host::withoutMemory() const {
  HostDevice without = handles;
  without.memory = {};
  return without;
}

Host::~Host() {
  vkDestroyDevice(handles.device, nullptr);  // the layers report what an engine has leaked
  const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
      vkGetInstanceProcAddr(handles.instance, "vkDestroyDebugUtilsMessengerEXT"));
  destroy(handles.instance, messenger_, nullptr);
  vkDestroyInstance(handles.instance, nullptr);
}

Device Host::own() const {
  HostDevice unwatched = withoutMemory();
  unwatched.getInstanceProcAddr = vkGetInstanceProcAddr;
  unwatched.debugNames = false;  // DeviceOptions::debugNames says why
  return Device::adopt(unwatched);
}

const Device& watchedDevice() {
  struct Watched {
    Host host;
    Device device = Device::adopt(host.handles);
  };
  return onceInRun([] { return Watched(); }).device;
}

Allocations allocations() {
  return {allocated, live};
}

const VkAllocationCallbacks* countingAllocator() {
  static const VkAllocationCallbacks kCallbacks{
      .pfnAllocation = allocate, .pfnReallocation = reallocate, .pfnFree = release};
  return &kCallbacks;
}

}  // namespace radar::test
