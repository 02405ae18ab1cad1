// Opens a device: creates instance, device and queue, then adopts them like a host's.
#include <algorithm>
#include <cstring>

#include "gpu/api.h"
#include "gpu/device.h"
#include "gpu/requirements.h"
#include "math/float_environment.h"
#include "radar/radar.h"

namespace radar {

using gpu::check;

Device::Impl::Owned::~Owned() {
  if (device != VK_NULL_HANDLE) vk.DestroyDevice(device, nullptr);
  if (messenger != VK_NULL_HANDLE) vk.DestroyDebugUtilsMessengerEXT(instance, messenger, nullptr);
  if (instance != VK_NULL_HANDLE) vk.DestroyInstance(instance, nullptr);
}

namespace {

struct DeviceType {
  VkPhysicalDeviceType type;
  const char* name;
};
// Preferred first, as listed in DeviceOptions::index.
constexpr DeviceType kTypes[] = {{VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "discrete GPU"},
                                 {VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU, "integrated GPU"},
                                 {VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU, "virtual GPU"},
                                 {VK_PHYSICAL_DEVICE_TYPE_CPU, "CPU"},
                                 {VK_PHYSICAL_DEVICE_TYPE_OTHER, "other"}};

const DeviceType* typeOf(const VkPhysicalDeviceProperties& device) {
  return std::ranges::find(std::begin(kTypes), std::end(kTypes) - 1, device.deviceType, &DeviceType::type);
}

bool has(const std::vector<VkExtensionProperties>& extensions, const char* name) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

// `enumerate` is one of Vulkan's functions for them, with its first arguments bound.
template <class Enumerate>
std::vector<VkExtensionProperties> extensionsOf(const Enumerate& enumerate, const char* call) {
  uint32_t count = 0;
  check(enumerate(&count, nullptr), call);
  std::vector<VkExtensionProperties> extensions(count);
  check(enumerate(&count, extensions.data()), call);
  return extensions;
}

std::vector<VkExtensionProperties> extensionsOf(const gpu::Api& vk) {
  return extensionsOf([&](auto... out) { return vk.EnumerateInstanceExtensionProperties(nullptr, out...); },
                      "vkEnumerateInstanceExtensionProperties");
}

std::vector<VkExtensionProperties> extensionsOf(const gpu::Api& vk, VkPhysicalDevice device) {
  return extensionsOf([&](auto... out) { return vk.EnumerateDeviceExtensionProperties(device, nullptr, out...); },
                      "vkEnumerateDeviceExtensionProperties");
}

// Since release 1.4.309 the text no longer names the message.
std::string messageText(const VkDebugUtilsMessengerCallbackDataEXT& data) {
  return (data.pMessageIdName == nullptr ? "" : data.pMessageIdName + std::string(": ")) + data.pMessage;
}

// Passes on all messages, and lets the call that caused one proceed.
VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<Device::Impl::Owned*>(user)->onValidation(messageText(*data));
  return VK_FALSE;
}

std::unique_ptr<Device::Impl::Owned> openInstance(std::function<void(const std::string&)> onValidation) {
  auto owned = std::make_unique<Device::Impl::Owned>();
  owned->onValidation = std::move(onValidation);
  const bool listens = owned->onValidation != nullptr;
  const std::vector<VkExtensionProperties> available = extensionsOf(owned->vk);
  if (listens && !has(available, VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
    throw Error(Error::Kind::device,
                "DeviceOptions::onValidation: the instance extension VK_EXT_debug_utils is missing");
  }
  std::vector<const char*> extensions;
  if (listens) extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
  // Without it loaders hide drivers that lack parts of Vulkan, such as MoltenVK.
  const bool isPortable = has(available, VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
  if (isPortable) extensions.push_back(VK_KHR_PORTABILITY_ENUMERATION_EXTENSION_NAME);
  const VkDebugUtilsMessengerCreateInfoEXT messenger{
      .sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT,
      .messageSeverity =
          VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
      .messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT,
      .pfnUserCallback = onMessage,
      .pUserData = owned.get()};
  const VkApplicationInfo application{.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO,
                                      .pEngineName = "Cyber Radar",
                                      .engineVersion = VK_MAKE_VERSION(kVersionMajor, kVersionMinor, kVersionPatch),
                                      .apiVersion = VK_API_VERSION_1_3};
  const VkInstanceCreateInfo info{
      .sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
      .pNext = listens ? &messenger : nullptr,
      .flags = isPortable ? VkInstanceCreateFlags{VK_INSTANCE_CREATE_ENUMERATE_PORTABILITY_BIT_KHR} : 0,
      .pApplicationInfo = &application,
      .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
      .ppEnabledExtensionNames = extensions.data()};
  check(owned->vk.CreateInstance(&info, nullptr, &owned->instance), "vkCreateInstance (is a Vulkan driver installed?)");
  owned->vk.load(owned->instance);
  if (listens) {
    check(owned->vk.CreateDebugUtilsMessengerEXT(owned->instance, &messenger, nullptr, &owned->messenger),
          "vkCreateDebugUtilsMessengerEXT");
  }
  return owned;
}

std::vector<VkPhysicalDevice> physicalDevices(const gpu::Api& vk, VkInstance instance) {
  uint32_t count = 0;
  check(vk.EnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vk.EnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

uint64_t memoryOf(const gpu::Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceMemoryProperties memory;
  vk.GetPhysicalDeviceMemoryProperties(device, &memory);
  uint64_t most = 0;
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i) {
    const VkMemoryHeap& heap = memory.memoryHeaps[i];
    if ((heap.flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0) most = std::max<uint64_t>(most, heap.size);
  }
  return most;
}

DeviceReport report(const gpu::Api& vk, VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vk.GetPhysicalDeviceProperties(device, &properties);
  const gpu::DeviceFacts facts = gpu::factsOf(vk, device);
  return {properties.deviceName,
          gpu::driverText(vk, device, properties),
          typeOf(properties)->name,
          gpu::unsupportedReasons(facts, Mode::contact),
          gpu::unsupportedReasons(facts, Mode::sampled),
          gpu::versionText(facts.apiVersion),
          memoryOf(vk, device),
          facts.subgroups.size,
          facts.doubles,
          facts.limits};
}

VkPhysicalDevice choose(const gpu::Api& vk, const std::vector<VkPhysicalDevice>& devices, uint32_t index) {
  if (index != kNone && index >= devices.size()) {
    throw Error("device " + std::to_string(index) + " does not exist: there are " + std::to_string(devices.size()));
  }
  std::vector<std::string> lines;
  VkPhysicalDevice best = VK_NULL_HANDLE;
  const DeviceType* bestType = nullptr;
  for (uint32_t i = 0; i < devices.size(); ++i) {
    VkPhysicalDeviceProperties properties;
    vk.GetPhysicalDeviceProperties(devices[i], &properties);
    const std::vector<std::string> reasons = gpu::unsupportedReasons(gpu::factsOf(vk, devices[i]), Mode::contact);
    for (const std::string& reason : reasons) {
      lines.push_back("device " + std::to_string(i) + ", " + properties.deviceName + ": " + reason);
    }
    const DeviceType* const type = typeOf(properties);
    const bool wanted = index == kNone ? best == VK_NULL_HANDLE || type < bestType : i == index;
    if (reasons.empty() && wanted) {
      best = devices[i];
      bestType = type;
    }
  }
  if (best == VK_NULL_HANDLE) {
    throw Error(Error::Kind::device,
                index == kNone ? "no usable Vulkan device" : "device " + std::to_string(index) + " cannot be used",
                VK_SUCCESS, lines);
  }
  return best;
}

HostDevice hostOf(const gpu::Api& vk, VkInstance instance, const std::vector<VkPhysicalDevice>& devices,
                  uint32_t index) {
  HostDevice host{.instance = instance, .physicalDevice = choose(vk, devices, index)};
  host.queueFamily = gpu::queueFamilyOf(vk, host.physicalDevice);
  const gpu::DeviceFacts facts = gpu::factsOf(vk, host.physicalDevice);
  host.doubles = facts.doubles;
  host.sampled = gpu::unsupportedReasons(facts, Mode::sampled).empty();
  return host;
}

}  // namespace

// Threads that a driver starts have this one's environment.

std::vector<DeviceReport> listDevices() {
  const FloatEnvironment floats;
  const auto owned = openInstance(nullptr);
  std::vector<DeviceReport> reports;
  for (VkPhysicalDevice device : physicalDevices(owned->vk, owned->instance))
    reports.push_back(report(owned->vk, device));
  return reports;
}

HostDevice hostOf(VkInstance instance, VkPhysicalDevice physicalDevice, PFN_vkGetInstanceProcAddr getInstanceProcAddr) {
  const FloatEnvironment floats;
  if (instance == VK_NULL_HANDLE) throw Error("hostOf: expected an instance, got null");
  gpu::Api vk(getInstanceProcAddr);
  vk.load(instance);
  const bool isGiven = physicalDevice != VK_NULL_HANDLE;
  HostDevice host = hostOf(vk, instance, isGiven ? std::vector{physicalDevice} : physicalDevices(vk, instance), kNone);
  host.getInstanceProcAddr = getInstanceProcAddr;
  return host;
}

namespace {

struct Opened {
  std::unique_ptr<Device::Impl::Owned> owned;
  HostDevice host;
  bool capturesStatistics = false;
};

Opened openHandles(const DeviceOptions& options, bool wantsStatistics) {
  auto owned = openInstance(options.onValidation);
  HostDevice host = hostOf(owned->vk, owned->instance, physicalDevices(owned->vk, owned->instance), options.index);
  host.doubles = options.doubles && host.doubles;
  host.debugNames = options.debugNames && options.onValidation != nullptr;
  host.onCompiling = options.onCompiling;
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = host.queueFamily,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  Requirements needed = requirements(host);
  const std::vector<VkExtensionProperties> available = extensionsOf(owned->vk, host.physicalDevice);
  std::vector<const char*> extensions;
  // Such a driver wants to be told that the application knows.
  if (has(available, "VK_KHR_portability_subset")) extensions.push_back("VK_KHR_portability_subset");
  VkPhysicalDevicePipelineExecutablePropertiesFeaturesKHR statistics{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PIPELINE_EXECUTABLE_PROPERTIES_FEATURES_KHR};
  const bool capturesStatistics =
      wantsStatistics && has(available, VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
  if (capturesStatistics) {
    extensions.push_back(VK_KHR_PIPELINE_EXECUTABLE_PROPERTIES_EXTENSION_NAME);
    statistics.pipelineExecutableInfo = VK_TRUE;
  }
  VkPhysicalDeviceShaderSubgroupUniformControlFlowFeaturesKHR flow{
      .sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_FEATURES_KHR};
  if (has(available, VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME)) {
    VkPhysicalDeviceFeatures2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, .pNext = &flow};
    owned->vk.GetPhysicalDeviceFeatures2(host.physicalDevice, &chain);
    host.uniformControlFlow = flow.shaderSubgroupUniformControlFlow == VK_TRUE;
  }
  flow.pNext = capturesStatistics ? &statistics : nullptr;
  if (host.uniformControlFlow) extensions.push_back(VK_KHR_SHADER_SUBGROUP_UNIFORM_CONTROL_FLOW_EXTENSION_NAME);
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = needed.chain(host.uniformControlFlow ? &flow : flow.pNext),
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue,
                                .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                .ppEnabledExtensionNames = extensions.data()};
  check(owned->vk.CreateDevice(host.physicalDevice, &info, nullptr, &owned->device), "vkCreateDevice");
  owned->vk.load(owned->device);
  host.device = owned->device;
  owned->vk.GetDeviceQueue(host.device, host.queueFamily, 0, &host.queue);
  return {std::move(owned), host, capturesStatistics};
}

}  // namespace

Device Device::open(const DeviceOptions& options) {
  const FloatEnvironment floats;
  Opened opened = openHandles(options, false);
  Device device = adopt(opened.host);
  device.impl_->owned = std::move(opened.owned);
  return device;
}

std::unique_ptr<Device::Impl> gpu::openForStatistics(uint32_t index) {
  Opened opened = openHandles({.index = index}, true);
  auto impl = std::make_unique<Device::Impl>(opened.host);
  impl->owned = std::move(opened.owned);
  impl->doubles = opened.host.doubles;
  impl->capturesStatistics = opened.capturesStatistics;
  return impl;
}

}  // namespace radar
