#include "gpu/device.h"

#include <algorithm>

#include "gpu/api.h"
#include "gpu/arithmetic.h"
#include "gpu/memory.h"
#include "gpu/requirements.h"
#include "math/float_environment.h"

namespace radar {

using gpu::check;

std::string gpu::driverText(const gpu::Api& vk, VkPhysicalDevice device, const VkPhysicalDeviceProperties& properties) {
  if (properties.apiVersion < VK_API_VERSION_1_2) return "version " + std::to_string(properties.driverVersion);
  VkPhysicalDeviceDriverProperties driver{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceProperties2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &driver};
  vk.GetPhysicalDeviceProperties2(device, &chain);
  return std::string(driver.driverName) + " " + driver.driverInfo;
}

Device::Impl::Impl(const HostDevice& given)
    : host(given), vk(given.getInstanceProcAddr), allocator(std::make_unique<gpu::Allocator>(*this)) {
  vk.load(host.instance);
  vk.load(host.device);
  vk.GetPhysicalDeviceProperties(host.physicalDevice, &properties);
  vk.GetPhysicalDeviceMemoryProperties(host.physicalDevice, &memory);
  name = properties.deviceName;
  driver = gpu::driverText(vk, host.physicalDevice, properties);
  const gpu::SubgroupFacts subgroups = gpu::subgroupFactsOf(vk, host.physicalDevice);
  subgroupSize = subgroups.size;
  choosesSubgroupSize = subgroups.canChoose;
  if (host.sampled) {
    const gpu::DeviceFacts facts = gpu::factsOf(vk, host.physicalDevice);
    choosesLayers = facts.outputLayer;
    reasonsAgainstSampled = gpu::unsupportedReasons(facts, Mode::sampled);
    const VkQueueFlags queue = gpu::queueFlagsOf(vk, host.physicalDevice, host.queueFamily);
    if (reasonsAgainstSampled.empty() && (queue & VK_QUEUE_GRAPHICS_BIT) == 0) {
      reasonsAgainstSampled = {"queue family " + std::to_string(host.queueFamily) + " does not support graphics"};
    }
  } else {
    reasonsAgainstSampled = {"HostDevice::sampled is false"};
  }
  VkPhysicalDeviceVulkan13Properties sizes{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_PROPERTIES};
  VkPhysicalDeviceProperties2 chain{.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, .pNext = &sizes};
  vk.GetPhysicalDeviceProperties2(host.physicalDevice, &chain);
  maxBufferBytes = sizes.maxBufferSize;
  maxLayers = std::min(properties.limits.maxImageArrayLayers, properties.limits.maxFramebufferLayers);
}

Device::Impl::~Impl() {
  if (abandoned) static_cast<void>(owned.release());
}

void Device::Impl::requireSampled(const std::string& who) const {
  if (reasonsAgainstSampled.empty()) return;
  throw Error(who + ": " + name + " does not support mode sampled", VK_SUCCESS, reasonsAgainstSampled);
}

void Device::Impl::requireQueue(const char* who) const {
  if (host.queue != VK_NULL_HANDLE) return;
  throw Error(std::string("HostDevice::queue is null; ") + who + " needs a queue to submit to");
}

void Device::Impl::setName(VkObjectType type, uint64_t handle, const char* text) const {
  if (!host.debugNames) return;
  const VkDebugUtilsObjectNameInfoEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT,
                                           .objectType = type,
                                           .objectHandle = handle,
                                           .pObjectName = text};
  check(vk.SetDebugUtilsObjectNameEXT(device(), &info), "vkSetDebugUtilsObjectNameEXT");
}

void Device::Impl::beginLabel(const gpu::Commands& commands, const char* label) const {
  if (!host.debugNames) return;
  const VkDebugUtilsLabelEXT info{.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_LABEL_EXT, .pLabelName = label};
  vk.CmdBeginDebugUtilsLabelEXT(commands, &info);
}

void Device::Impl::endLabel(const gpu::Commands& commands) const {
  if (host.debugNames) vk.CmdEndDebugUtilsLabelEXT(commands);
}

Device::Impl::Shared& Device::Impl::sharedOf(std::type_index type) const {
  const std::lock_guard lock(sharedMutex_);
  return shared_[type];
}

std::vector<std::string> unsupportedReasons(const HostDevice& host, Mode mode) {
  if (host.instance == VK_NULL_HANDLE) return {"HostDevice::instance is null"};
  if (host.physicalDevice == VK_NULL_HANDLE) return {"HostDevice::physicalDevice is null"};
  gpu::Api vk(host.getInstanceProcAddr);
  vk.load(host.instance);
  return gpu::unsupportedReasons(gpu::factsOf(vk, host.physicalDevice), mode);
}

Requirements requirements(const HostDevice& host) {
  gpu::Api vk(host.getInstanceProcAddr);
  vk.load(host.instance);
  return gpu::requirements(host.doubles, host.sampled && gpu::factsOf(vk, host.physicalDevice).outputLayer);
}

namespace {

std::vector<std::string> failedChecks(const std::vector<ArithmeticCheck>& checks) {
  std::vector<std::string> lines;
  for (const ArithmeticCheck& check : checks) {
    if (check.passed()) continue;
    lines.push_back(check.operation + ": " + std::to_string(check.wrong) + " of " + std::to_string(check.tried) +
                    " wrong, needed: " + check.needed);
  }
  return lines;
}

// Of what a host may have filled in wrongly, and no physical device is to blame for.
std::vector<std::string> reasonsAgainst(const HostDevice& host) {
  std::vector<std::string> reasons = unsupportedReasons(host, Mode::contact);
  if (host.device == VK_NULL_HANDLE) reasons.emplace_back("HostDevice::device is null");
  if (!reasons.empty()) return reasons;
  gpu::Api vk(host.getInstanceProcAddr);
  vk.load(host.instance);
  if ((gpu::queueFlagsOf(vk, host.physicalDevice, host.queueFamily) & VK_QUEUE_COMPUTE_BIT) == 0) {
    reasons.push_back("HostDevice::queueFamily: family " + std::to_string(host.queueFamily) +
                      " does not exist, or does not support compute");
  }
  if (host.debugNames && vk.SetDebugUtilsObjectNameEXT == nullptr) {
    reasons.emplace_back("HostDevice::debugNames: the instance lacks VK_EXT_debug_utils");
  }
  return reasons;
}

}  // namespace

Device Device::adopt(const HostDevice& host) {
  const FloatEnvironment floats;
  const std::vector<std::string> reasons = reasonsAgainst(host);
  if (!reasons.empty()) throw Error("the adopted device cannot be used", VK_SUCCESS, reasons);
  if (!host.memory.allocate != !host.memory.free) {
    throw Error("HostDevice::memory: expected both functions or none, got one");
  }
  auto impl = std::make_unique<Impl>(host);
  // Without a queue nothing can be checked; composed quotients are correct on every device whose doubles are.
  impl->doubles = host.doubles;
  if (host.queue != VK_NULL_HANDLE) {
    const gpu::Arithmetic arithmetic = gpu::tryArithmetic(*impl, host.doubles);
    if (!arithmetic.floats) throw Error(impl->name + " cannot be used", VK_SUCCESS, failedChecks(arithmetic.checks));
    impl->doubles = arithmetic.doubles;
    impl->dividesRight = arithmetic.dividesRight;
  }
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
bool Device::supports(Mode mode) const {
  return mode == Mode::contact || impl_->reasonsAgainstSampled.empty();
}
const HostDevice& Device::handles() const {
  return impl_->host;
}
MemoryUse Device::memoryUse() const {
  return impl_->allocator->use();
}

}  // namespace radar
