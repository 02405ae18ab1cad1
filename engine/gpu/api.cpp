#include "gpu/api.h"

#include <string>

#if defined(_WIN32)
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
#else
#include <dlfcn.h>
#endif

namespace radar::gpu {

namespace {

#if defined(_WIN32)
constexpr const char* kLoader = "vulkan-1.dll";
void* findLoader() {
  const HMODULE loader = LoadLibraryA(kLoader);
  return loader == nullptr ? nullptr : reinterpret_cast<void*>(GetProcAddress(loader, "vkGetInstanceProcAddr"));
}
#else
#if defined(__APPLE__)
constexpr const char* kLoader = "libvulkan.1.dylib";
#else
constexpr const char* kLoader = "libvulkan.so.1";
#endif
void* findLoader() {
  void* loader = dlopen(kLoader, RTLD_NOW | RTLD_LOCAL);
  return loader == nullptr ? nullptr : dlsym(loader, "vkGetInstanceProcAddr");
}
#endif

PFN_vkVoidFunction required(PFN_vkVoidFunction function, const char* name) {
  if (function == nullptr)
    throw Error(Error::Kind::device,
                std::string("the Vulkan function ") + name +
                    " is missing: instance (VkApplicationInfo::apiVersion) and device need Vulkan 1.3");
  return function;
}

}  // namespace

PFN_vkGetInstanceProcAddr systemLoader() {
  static void* const kFound = findLoader();
  if (kFound == nullptr) {
    throw Error(Error::Kind::device, std::string("no Vulkan loader: ") + kLoader + " is not installed");
  }
  return reinterpret_cast<PFN_vkGetInstanceProcAddr>(kFound);
}

Api::Api(PFN_vkGetInstanceProcAddr get) : GetInstanceProcAddr(get != nullptr ? get : systemLoader()) {
#define RADAR_LOAD(name) \
  name = reinterpret_cast<PFN_vk##name>(required(GetInstanceProcAddr(nullptr, "vk" #name), "vk" #name));
  RADAR_GLOBAL_FUNCTIONS(RADAR_LOAD)
#undef RADAR_LOAD
}

void Api::load(VkInstance instance) {
#define RADAR_LOAD(name) \
  name = reinterpret_cast<PFN_vk##name>(required(GetInstanceProcAddr(instance, "vk" #name), "vk" #name));
  RADAR_INSTANCE_FUNCTIONS(RADAR_LOAD)
#undef RADAR_LOAD
#define RADAR_LOAD(name) name = reinterpret_cast<PFN_vk##name>(GetInstanceProcAddr(instance, "vk" #name));
  RADAR_DEBUG_FUNCTIONS(RADAR_LOAD)
#undef RADAR_LOAD
}

void Api::load(VkDevice device) {
#define RADAR_LOAD(name) \
  name = reinterpret_cast<PFN_vk##name>(required(GetDeviceProcAddr(device, "vk" #name), "vk" #name));
  RADAR_DEVICE_FUNCTIONS(RADAR_LOAD)
#undef RADAR_LOAD
#define RADAR_LOAD(name) name = reinterpret_cast<PFN_vk##name>(GetDeviceProcAddr(device, "vk" #name));
  RADAR_STATISTICS_FUNCTIONS(RADAR_LOAD)
#undef RADAR_LOAD
}

const char* resultName(VkResult result) {
  switch (result) {
#define RADAR_CASE(name) \
  case name:             \
    return #name;
    RADAR_CASE(VK_SUCCESS)
    RADAR_CASE(VK_NOT_READY)
    RADAR_CASE(VK_TIMEOUT)
    RADAR_CASE(VK_INCOMPLETE)
    RADAR_CASE(VK_ERROR_OUT_OF_HOST_MEMORY)
    RADAR_CASE(VK_ERROR_OUT_OF_DEVICE_MEMORY)
    RADAR_CASE(VK_ERROR_INITIALIZATION_FAILED)
    RADAR_CASE(VK_ERROR_DEVICE_LOST)
    RADAR_CASE(VK_ERROR_MEMORY_MAP_FAILED)
    RADAR_CASE(VK_ERROR_LAYER_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_EXTENSION_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_FEATURE_NOT_PRESENT)
    RADAR_CASE(VK_ERROR_INCOMPATIBLE_DRIVER)
    RADAR_CASE(VK_ERROR_TOO_MANY_OBJECTS)
    RADAR_CASE(VK_ERROR_FORMAT_NOT_SUPPORTED)
    RADAR_CASE(VK_ERROR_FRAGMENTED_POOL)
    RADAR_CASE(VK_ERROR_OUT_OF_POOL_MEMORY)
#undef RADAR_CASE
    default:
      return "unknown VkResult";
  }
}

void check(VkResult result, const char* call, const char* about, uint64_t size, const char* unit) {
  if (result >= VK_SUCCESS) return;
  std::string text = call;
  if (about) text += std::string(" (") + about;
  if (size > 0) text += (about ? ", " : " (") + std::to_string(size) + " " + unit;
  if (about || size > 0) text += ")";
  throw Error(text + ": " + resultName(result) + " (" + std::to_string(result) + ")", result);
}

bool isOutOfMemory(const Error& error) {
  return error.vulkan == VK_ERROR_OUT_OF_HOST_MEMORY || error.vulkan == VK_ERROR_OUT_OF_DEVICE_MEMORY;
}

bool isLost(const Error& error) {
  return error.vulkan == VK_ERROR_DEVICE_LOST;
}

}  // namespace radar::gpu
