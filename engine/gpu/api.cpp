#include "gpu/api.h"

#include <string>

#include "radar/device.h"

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
    throw Error(std::string("the Vulkan function ") + name +
                " is missing: instance (VkApplicationInfo::apiVersion) and device need Vulkan 1.3");
  return function;
}

}  // namespace

PFN_vkGetInstanceProcAddr systemLoader() {
  static void* const kFound = findLoader();
  if (kFound == nullptr) throw Error(std::string("no Vulkan loader: ") + kLoader + " is not installed");
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

}  // namespace radar::gpu
