#include "gpu/device.h"

#include <algorithm>
#include <cstring>

#include "gpu/check.h"
#include "gpu/doubles.h"
#include "gpu/requirements.h"

namespace radar {

using gpu::check;

Device::Impl::Owned::~Owned() {
  if (device != VK_NULL_HANDLE) vkDestroyDevice(device, nullptr);
  if (messenger != VK_NULL_HANDLE) {
    const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
    destroy(instance, messenger, nullptr);
  }
  if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
}

namespace {

const char* typeText(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return "discrete GPU";
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return "integrated GPU";
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return "virtual GPU";
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return "CPU";
    default:
      return "other";
  }
}

// Preferred first, as listed in DeviceOptions::index.
int preference(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 3;
    default:
      return 4;
  }
}

std::string driverText(VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties) {
  if (properties.apiVersion < VK_API_VERSION_1_2) return "version " + std::to_string(properties.driverVersion);
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  vkGetPhysicalDeviceProperties2(device, &chain);
  return std::string(driver.driverName) + " " + driver.driverInfo;
}

bool hasExtension(const char* name) {
  uint32_t count = 0;
  check(vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr), "vkEnumerateInstanceExtensionProperties");
  std::vector<VkExtensionProperties> extensions(count);
  check(vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data()),
        "vkEnumerateInstanceExtensionProperties");
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const VkExtensionProperties& e) { return std::strcmp(e.extensionName, name) == 0; });
}

// Throws away nothing that the layers call a warning or an error.
VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  static_cast<Device::Impl::Owned*>(user)->onValidation(data->pMessage);
  return VK_FALSE;
}

std::unique_ptr<Device::Impl::Owned> openInstance(std::function<void(const std::string&)> onValidation) {
  auto owned = std::make_unique<Device::Impl::Owned>();
  owned->onValidation = std::move(onValidation);
  const bool listens = owned->onValidation != nullptr;
  if (listens && !hasExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) {
    throw Error("DeviceOptions::onValidation: the instance extension VK_EXT_debug_utils is missing");
  }
  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME};
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
  const VkInstanceCreateInfo info{.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO,
                                  .pNext = listens ? &messenger : nullptr,
                                  .pApplicationInfo = &application,
                                  .enabledExtensionCount = listens ? 1u : 0u,
                                  .ppEnabledExtensionNames = extensions};
  check(vkCreateInstance(&info, nullptr, &owned->instance), "vkCreateInstance (is a Vulkan driver installed?)");
  if (listens) {
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(owned->instance, "vkCreateDebugUtilsMessengerEXT"));
    check(create(owned->instance, &messenger, nullptr, &owned->messenger), "vkCreateDebugUtilsMessengerEXT");
  }
  return owned;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

DeviceReport report(VkPhysicalDevice device) {
  VkPhysicalDeviceProperties properties;
  vkGetPhysicalDeviceProperties(device, &properties);
  return {properties.deviceName, driverText(device, properties), typeText(properties.deviceType),
          gpu::reasonsAgainst(gpu::factsOf(device))};
}

VkPhysicalDevice choose(const std::vector<VkPhysicalDevice>& devices, uint32_t index) {
  if (index != kNone && index >= devices.size()) {
    throw Error("device " + std::to_string(index) + " does not exist: there are " + std::to_string(devices.size()));
  }
  std::vector<std::string> lines;
  VkPhysicalDevice best = VK_NULL_HANDLE;
  int bestPreference = 0;
  for (uint32_t i = 0; i < devices.size(); ++i) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(devices[i], &properties);
    const std::vector<std::string> reasons = gpu::reasonsAgainst(gpu::factsOf(devices[i]));
    for (const std::string& reason : reasons) {
      lines.push_back("device " + std::to_string(i) + ", " + properties.deviceName + ": " + reason);
    }
    const int rank = preference(properties.deviceType);
    const bool wanted = index == kNone ? best == VK_NULL_HANDLE || rank < bestPreference : i == index;
    if (reasons.empty() && wanted) {
      best = devices[i];
      bestPreference = rank;
    }
  }
  if (best == VK_NULL_HANDLE) {
    throw Error(index == kNone ? "no usable Vulkan device" : "device " + std::to_string(index) + " cannot be used",
                VK_SUCCESS, lines);
  }
  return best;
}

}  // namespace

uint32_t gpu::queueFamilyOf(VkPhysicalDevice device) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
  constexpr VkQueueFlags kNeeded = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
  for (uint32_t i = 0; i < count; ++i) {
    if ((families[i].queueFlags & kNeeded) == kNeeded) return i;
  }
  return kNone;
}

std::vector<DeviceReport> listDevices() {
  const auto owned = openInstance(nullptr);
  std::vector<DeviceReport> reports;
  for (VkPhysicalDevice device : physicalDevices(owned->instance)) reports.push_back(report(device));
  return reports;
}

Device::Impl::Impl(const HostDevice& given) : host(given) {
  vkGetPhysicalDeviceProperties(host.physicalDevice, &properties);
  vkGetPhysicalDeviceMemoryProperties(host.physicalDevice, &memory);
  name = properties.deviceName;
  driver = driverText(host.physicalDevice, properties);
  VkPhysicalDeviceVulkan11Properties subgroup{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &subgroup};
  vkGetPhysicalDeviceProperties2(host.physicalDevice, &chain);
  subgroupSize = subgroup.subgroupSize;
  maxLayers = std::min(properties.limits.maxImageArrayLayers, properties.limits.maxFramebufferLayers);
  if (!host.debugNames) return;
  setObjectName = reinterpret_cast<PFN_vkSetDebugUtilsObjectNameEXT>(
      vkGetInstanceProcAddr(host.instance, "vkSetDebugUtilsObjectNameEXT"));
  cmdBeginLabel = reinterpret_cast<PFN_vkCmdBeginDebugUtilsLabelEXT>(
      vkGetInstanceProcAddr(host.instance, "vkCmdBeginDebugUtilsLabelEXT"));
  cmdEndLabel = reinterpret_cast<PFN_vkCmdEndDebugUtilsLabelEXT>(
      vkGetInstanceProcAddr(host.instance, "vkCmdEndDebugUtilsLabelEXT"));
}

Device::Impl::~Impl() = default;

void Device::Impl::setName(VkObjectType type, uint64_t handle, const char* text) const {
  if (setObjectName == nullptr) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = handle,
                                           .pObjectName = text};
  check(setObjectName(device(), &info), "vkSetDebugUtilsObjectNameEXT");
}

void Device::Impl::beginLabel(VkCommandBuffer commands, const char* label) const {
  if (cmdBeginLabel == nullptr) return;
  const VkDebugUtilsLabelEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = label};
  cmdBeginLabel(commands, &info);
}

void Device::Impl::endLabel(VkCommandBuffer commands) const {
  if (cmdEndLabel != nullptr) cmdEndLabel(commands);
}

Device Device::open(const DeviceOptions& options) {
  auto owned = openInstance(options.onValidation);
  HostDevice host{.instance = owned->instance, .debugNames = options.onValidation != nullptr};
  host.physicalDevice = choose(physicalDevices(owned->instance), options.index);
  host.queueFamily = gpu::queueFamilyOf(host.physicalDevice);
  const float priority = 1.0f;
  const VkDeviceQueueCreateInfo queue{.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO,
                                      .queueFamilyIndex = host.queueFamily,
                                      .queueCount = 1,
                                      .pQueuePriorities = &priority};
  host.doubles = options.doubles && gpu::factsOf(host.physicalDevice).doubles;
  gpu::Features features;
  gpu::enableRequired(features, host.doubles);
  const VkDeviceCreateInfo info{.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO,
                                .pNext = &features.core,
                                .queueCreateInfoCount = 1,
                                .pQueueCreateInfos = &queue};
  check(vkCreateDevice(host.physicalDevice, &info, nullptr, &owned->device), "vkCreateDevice");
  host.device = owned->device;
  vkGetDeviceQueue(host.device, host.queueFamily, 0, &host.queue);
  Device device = adopt(host);
  device.impl_->owned = std::move(owned);
  return device;
}

Device Device::adopt(const HostDevice& host) {
  const std::vector<std::string> reasons = gpu::reasonsAgainst(gpu::factsOf(host.physicalDevice));
  if (!reasons.empty()) throw Error("the adopted device cannot be used", VK_SUCCESS, reasons);
  auto impl = std::make_unique<Impl>(host);
  impl->doubles = host.doubles && gpu::doublesAreRight(*impl);
  return Device(std::move(impl));
}

Device::Device(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Device::~Device() = default;
Device::Device(Device&&) noexcept = default;
Device& Device::operator=(Device&&) noexcept = default;
const std::string& Device::name() const {
  return impl_->name;
}
const std::string& Device::driver() const {
  return impl_->driver;
}
bool Device::doubles() const {
  return impl_->doubles;
}
const HostDevice& Device::handles() const {
  return impl_->host;
}

}  // namespace radar
