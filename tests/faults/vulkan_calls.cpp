#include "faults/vulkan_calls.h"

#include <cstdint>
#include <cstring>
#include <limits>
#include <string_view>
#include <type_traits>

#include <vulkan/vulkan.h>

#include "faults/host_memory.h"
#include "gpu/api.h"

namespace radar::test {

namespace {

constexpr int64_t kNever = std::numeric_limits<int64_t>::max();

struct Fault {
  std::atomic<int64_t> left{kNever};
  VkResult result = VK_SUCCESS;
  VulkanFault::When when = VulkanFault::When::once;
  const void *device = nullptr, *queue = nullptr;
  std::atomic<const char*> failed{nullptr};
};
Fault fault;
std::atomic<int64_t> live{0};
std::atomic<bool> areHollow{false};

bool reportsLoss(std::string_view name) {
  return name == "vkQueueSubmit2" || name == "vkWaitForFences" || name == "vkGetQueryPoolResults";
}

bool concerns(const void* handle) {
  return fault.device == nullptr || handle == fault.device || handle == fault.queue;
}

bool fails(const char* name, const void* handle) {
  if (fault.left == kNever || !concerns(handle)) return false;
  if (fault.when == VulkanFault::When::lost && !reportsLoss(name)) return false;
  const int64_t left = fault.left--;
  if (left > 0 || (left < 0 && fault.when == VulkanFault::When::once)) return false;
  const char* none = nullptr;
  fault.failed.compare_exchange_strong(none, name);
  return true;
}

// Its address is the handle of all objects that are not made.
char hollowObject;

template <class Handle>
bool isHollow(Handle handle) {
  return reinterpret_cast<const char*>(handle) == &hollowObject;
}

template <class Handle>
VkResult makeHollow(Handle* handle) {
  *handle = reinterpret_cast<Handle>(&hollowObject);
  return VK_SUCCESS;
}

// What replaces a function under HollowPipelines.
VkResult hollow(VkDevice, const VkShaderModuleCreateInfo*, const VkAllocationCallbacks*, VkShaderModule* module) {
  return makeHollow(module);
}
template <class Info>
VkResult hollow(VkDevice, VkPipelineCache, uint32_t, const Info*, const VkAllocationCallbacks*, VkPipeline* pipeline) {
  return makeHollow(pipeline);
}

VkResult hollow(VkDevice, const VkDebugUtilsObjectNameInfoEXT*) {
  return VK_SUCCESS;
}

// Counts what a function has created, by the form of its arguments.
template <class Info, class Handle>
void created(VkDevice, const Info*, const VkAllocationCallbacks*, Handle* handle) {
  live += *handle == VK_NULL_HANDLE ? 0 : 1;
}
template <class Info>
void created(VkDevice, VkPipelineCache, uint32_t, const Info*, const VkAllocationCallbacks*, VkPipeline*) {
  ++live;
}

// Memory begins with garbage, so that what was never written is not taken for what it happened to be.
void created(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks*, VkDeviceMemory* memory) {
  ++live;
  void* bytes = nullptr;
  if (vkMapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, &bytes) != VK_SUCCESS) return;
  std::memset(bytes, 0xfe, info->allocationSize);
  vkUnmapMemory(device, *memory);
}

template <class First, class... Rest>
const void* firstOf(First first, Rest...) {
  if constexpr (std::is_pointer_v<First>) {
    return first;
  } else {
    return nullptr;
  }
}

/// Stands for one function.
template <auto Member>
struct Wrapped;
template <class R, class... Args, R (VKAPI_PTR* gpu::Api::*Member)(Args...)>
struct Wrapped<Member> {
  static inline const char* name = "";
  static inline R(VKAPI_PTR* driver)(Args...) = nullptr;

  static VKAPI_ATTR R VKAPI_CALL call(Args... args) {
    const OthersWork others;
    if constexpr (requires { destroyed(args...); }) {
      if (!destroyed(args...)) return;
    }
    if constexpr (std::is_same_v<R, VkResult>) {
      if (fails(name, firstOf(args...))) {
        const bool waits = std::string_view(name) == "vkWaitForFences" && fault.when == VulkanFault::When::lost;
        if (waits) driver(args...);
        return fault.result;
      }
      VkResult result;
      if constexpr (requires { hollow(args...); }) {
        result = areHollow ? hollow(args...) : driver(args...);
      } else {
        result = driver(args...);
      }
      if constexpr (requires { created(args...); }) {
        if (result == VK_SUCCESS) created(args...);
      }
      return result;
    } else {
      return driver(args...);
    }
  }

 private:
  // Counts; returns whether the driver made it.
  template <class Handle>
  static bool destroyed(VkDevice, Handle handle, const VkAllocationCallbacks*) {
    live -= handle == VK_NULL_HANDLE ? 0 : 1;
    return !isHollow(handle);
  }
};

// The wrapper of one function, made to call the driver's; null for others.
template <auto Member>
PFN_vkVoidFunction wrap(VkInstance instance, const char* name) {
  using Function = std::remove_cvref_t<decltype(Wrapped<Member>::driver)>;
  Wrapped<Member>::name = name;
  Wrapped<Member>::driver = reinterpret_cast<Function>(vkGetInstanceProcAddr(instance, name));
  if (Wrapped<Member>::driver == nullptr) return nullptr;
  return reinterpret_cast<PFN_vkVoidFunction>(&Wrapped<Member>::call);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* wanted);

VkInstance lastInstance = VK_NULL_HANDLE;

// The loader's own functions find the device's by its handle.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL deviceFunction(VkDevice, const char* name) {
  return instanceFunction(lastInstance, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL instanceFunction(VkInstance instance, const char* wanted) {
  const OthersWork others;
  const std::string_view name = wanted;
  lastInstance = instance;
  if (name == "vkGetDeviceProcAddr") return reinterpret_cast<PFN_vkVoidFunction>(deviceFunction);
#define RADAR_WRAP(function) \
  if (name == "vk" #function) return wrap<&gpu::Api::function>(instance, "vk" #function);
  RADAR_GLOBAL_FUNCTIONS(RADAR_WRAP)
  RADAR_INSTANCE_FUNCTIONS(RADAR_WRAP)
  RADAR_DEVICE_FUNCTIONS(RADAR_WRAP)
  RADAR_DEBUG_FUNCTIONS(RADAR_WRAP)
#undef RADAR_WRAP
  return vkGetInstanceProcAddr(instance, wanted);
}

}  // namespace

PFN_vkGetInstanceProcAddr faultyLoader() {
  return instanceFunction;
}

VulkanFault::VulkanFault(int64_t n, VkResult result, When when, VkDevice device, VkQueue queue) {
  fault.result = result;
  fault.when = when;
  fault.device = device;
  fault.queue = queue;
  fault.failed = nullptr;
  fault.left = n;
}

VulkanFault::~VulkanFault() {
  fault.left = kNever;
}

bool VulkanFault::happened() const {
  return fault.failed != nullptr;
}

std::string VulkanFault::failed() const {
  return happened() ? fault.failed.load() : "";
}

int64_t liveVulkanObjects() {
  return live;
}

HollowPipelines::HollowPipelines() {
  areHollow = true;
}

HollowPipelines::~HollowPipelines() {
  areHollow = false;
}

}  // namespace radar::test
