#include "support/watched_vulkan.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <mutex>
#include <set>
#include <type_traits>

#include <vulkan/vulkan.h>

#include "gpu/api.h"
#include "support/engine_work.h"

namespace radar::test {

namespace {

constexpr int64_t kNever = std::numeric_limits<int64_t>::max();

struct Fault {
  std::atomic<int64_t> left{kNever};
  VkResult result = VK_SUCCESS;
  VulkanFault::When when = VulkanFault::When::once;
  const void *device = nullptr, *queue = nullptr;
  std::string_view name;
  std::atomic<const char*> failed{nullptr};
};
Fault fault;
std::atomic<int64_t> live{0};
std::atomic<uint64_t> allocatedBytes{0};
std::atomic<bool> areHollow{false}, areInTurn{false}, areLabelled{false};
std::atomic<VkPipelineCache> pipelineCache{VK_NULL_HANDLE};
std::atomic<uint32_t> visibleTypes{0};  // a bit for each type of memory that a host can map
std::mutex turns;

std::mutex mutex;  // of what follows
std::set<std::string> lookedUp;
std::map<std::string, const std::atomic<uint64_t>*> calls;
bool areHeld = false;
int held = 0;
std::condition_variable changed;

bool reportsLoss(std::string_view name) {
  return name == "vkQueueSubmit2" || name == "vkWaitForFences" || name == "vkGetQueryPoolResults";
}

bool concerns(std::string_view name, const void* handle) {
  return (fault.device == nullptr || handle == fault.device || handle == fault.queue) &&
         (fault.name.empty() || name == fault.name);
}

bool fails(const char* name, const void* handle) {
  if (fault.left == kNever || !concerns(name, handle)) return false;
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
void created(VkDevice, VkPipelineCache cache, uint32_t, const Info*, const VkAllocationCallbacks*, VkPipeline*) {
  ++live;
  pipelineCache = cache;
}

// Tells which memory the next function may map.
void told(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* memory) {
  uint32_t types = 0;
  for (uint32_t i = 0; i < memory->memoryTypeCount; ++i) {
    const bool isVisible = (memory->memoryTypes[i].propertyFlags & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) != 0;
    types |= isVisible ? 1u << i : 0;
  }
  visibleTypes = types;
}

// Memory begins with garbage, so that what was never written is not taken for what it happened to be.
void created(VkDevice device, const VkMemoryAllocateInfo* info, const VkAllocationCallbacks*, VkDeviceMemory* memory) {
  ++live;
  allocatedBytes += info->allocationSize;
  void* bytes = nullptr;
  if ((visibleTypes >> info->memoryTypeIndex & 1) == 0) return;
  if (vkMapMemory(device, *memory, 0, VK_WHOLE_SIZE, 0, &bytes) != VK_SUCCESS) return;
  std::memset(bytes, 0xfe, info->allocationSize);
  vkUnmapMemory(device, *memory);
}

void hold() {
  std::unique_lock lock(mutex);
  held += areHeld ? 1 : 0;
  changed.notify_all();
  changed.wait(lock, [] { return !areHeld; });
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
  static inline std::atomic<uint64_t> count{0};

  static VKAPI_ATTR R VKAPI_CALL call(Args... args) {
    const OthersWork others;
    ++count;
    const bool isWait = std::string_view(name) == "vkWaitForFences";
    std::unique_lock turn(turns, std::defer_lock);
    if (areInTurn && (isWait || std::string_view(name) == "vkQueueSubmit2")) turn.lock();
    if constexpr (requires { destroyed(args...); }) {
      if (!destroyed(args...)) return;
    }
    if constexpr (std::is_same_v<R, VkResult>) {
      if (fails(name, firstOf(args...))) {
        if (isWait && fault.when == VulkanFault::When::lost) driver(args...);
        return fault.result;
      }
      VkResult result;
      if constexpr (requires { hollow(args...); }) {
        result = areHollow ? hollow(args...) : driver(args...);
      } else {
        result = driver(args...);
      }
      if (isWait) hold();
      if constexpr (requires { created(args...); }) {
        if (result == VK_SUCCESS) created(args...);
      }
      return result;
    } else if constexpr (requires { told(args...); }) {
      driver(args...);
      told(args...);
    } else {
      const bool isLabel = std::string_view(name).ends_with("DebugUtilsLabelEXT");
      return isLabel && !areLabelled ? R() : driver(args...);
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
  calls[name] = &Wrapped<Member>::count;
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
  const std::lock_guard lock(mutex);
  const std::string_view name = wanted;
  lookedUp.emplace(name);
  if (instance != VK_NULL_HANDLE) lastInstance = instance;  // another thread may load a device's functions meanwhile
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

PFN_vkGetInstanceProcAddr watchedLoader() {
  return instanceFunction;
}

bool isLookedUp(const std::string& name) {
  const std::lock_guard lock(mutex);
  return lookedUp.contains(name);
}

uint64_t callsOf(const std::string& name) {
  const std::lock_guard lock(mutex);
  const auto found = calls.find(name);
  return found == calls.end() ? 0 : found->second->load();
}

VkPipelineCache lastPipelineCache() {
  return pipelineCache;
}

VulkanFault::VulkanFault(int64_t n, VkResult result, When when, const FailingCalls& which) {
  fault.result = result;
  fault.when = when;
  fault.device = which.device == nullptr ? nullptr : which.device->device;
  fault.queue = which.device == nullptr ? nullptr : which.device->queue;
  fault.name = which.name;
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

uint64_t allocatedDeviceBytes() {
  return allocatedBytes;
}

int64_t liveVulkanObjects() {
  return live;
}

HeldWaits::HeldWaits() {
  const std::lock_guard lock(mutex);
  areHeld = true;
  held = 0;
}

void HeldWaits::await(int count) {
  std::unique_lock lock(mutex);
  changed.wait(lock, [&] { return held >= count; });
}

void HeldWaits::release() {
  const std::lock_guard lock(mutex);
  areHeld = false;
  changed.notify_all();
}

CallsInTurn::CallsInTurn() {
  areInTurn = true;
}

CallsInTurn::~CallsInTurn() {
  areInTurn = false;
}

HollowPipelines::HollowPipelines() {
  areHollow = true;
}

HollowPipelines::~HollowPipelines() {
  areHollow = false;
}

TrueLabels::TrueLabels() {
  areLabelled = true;
}

TrueLabels::~TrueLabels() {
  areLabelled = false;
}

}  // namespace radar::test
