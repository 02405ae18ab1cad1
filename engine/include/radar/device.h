// Vulkan devices, opened by the engine or a host's, and checks of what they compute.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "radar/query.h"

namespace radar {

/// A limit of a physical device that shaders rely on; `name` is its name in VkPhysicalDeviceLimits.
struct DeviceLimit {
  std::string name;
  uint64_t needed = 0, has = 0;  ///< the least value needed; the device's value
  Mode mode = Mode::contact;     ///< the mode that needs it; sampled needs everything that contact needs
};

/// What is known of a physical device.
struct DeviceReport {
  std::string name, driver, type;
  std::vector<std::string> reasons;         ///< why it cannot be used; empty if it can
  std::vector<std::string> sampledReasons;  ///< why it does not support mode sampled; empty if it does
  std::string version;                      ///< the device's Vulkan version: "1.3.224"
  uint64_t memory = 0;                      ///< size of the largest device-local heap, bytes
  uint32_t subgroup = 0;                    ///< invocations in a workgroup of the search; 0 before Vulkan 1.3
  bool doubles = false;                     ///< supports shaderFloat64
  std::vector<DeviceLimit> limits;          ///< empty before Vulkan 1.3
  bool usable() const { return reasons.empty(); }
};

/// Lists the Vulkan loader's physical devices, in its order. Throws if there is no loader or no driver.
RADAR_API std::vector<DeviceReport> listDevices();

/// Called each second, on the thread that waits, while a driver compiles a pipeline; with the shader's name and the
/// seconds so far. If it returns false, the device is given up: who waits gets an Error, or the CPU's answers, as if
/// the device were lost. Nothing on that device may then be destroyed, since its driver goes on.
using OnCompiling = std::function<bool(const std::string& shader, uint32_t seconds)>;

/// Memory that the engine needs for one buffer or image.
struct MemoryRequest {
  VkMemoryRequirements requirements{};
  VkMemoryPropertyFlags required = 0;   ///< VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT: also MemoryPiece::mapped
  VkMemoryPropertyFlags preferred = 0;  ///< in addition, if a memory type has them
  bool isImage = false;                 ///< with optimal tiling; else a buffer
  const char* name = "";                ///< of the buffer or image
};

/// A piece of device memory that nothing else uses until it is freed.
struct MemoryPiece {
  VkDeviceMemory memory = VK_NULL_HANDLE;
  VkDeviceSize offset = 0;  ///< bytes, a multiple of the alignment required
  void* mapped = nullptr;   ///< host address of `offset`
  void* handle = nullptr;   ///< the allocator's own, such as a VmaAllocation
};

/// A host's allocator of device memory, such as the Vulkan Memory Allocator: vmaAllocateMemory() and vmaFreeMemory().
/// The engine calls one of them at a time, on any thread that uses the Device; they call nothing of the engine, and
/// `free` does not throw.
struct HostMemory {
  std::function<VkResult(const MemoryRequest&, MemoryPiece&)> allocate{};
  std::function<void(const MemoryPiece&)> free{};
};

/// Device memory that the engine holds.
struct MemoryUse {
  uint64_t used = 0;         ///< by buffers and images, bytes
  uint64_t allocated = 0;    ///< from the driver or the host, bytes
  uint32_t allocations = 0;  ///< calls of vkAllocateMemory, or pieces of the host's, that hold it
};

/// Vulkan handles that the host owns. All outlive the Device made from them. `device` has the features of
/// requirements() enabled. `queue` belongs to family `queueFamily`, which supports compute and, for mode sampled,
/// graphics. hostOf() begins one.
///
/// `queue` may be null if the host makes every submission itself. The engine then never submits: a Recorder works in
/// full; a Sweeper, a Pool and addMesh() of a HostMesh throw Error. Without a queue the device's doubles cannot be
/// compared with the CPU's, so `doubles` is trusted: if they differ, answers may be wrong. If unsure, pass false, or
/// the value that Device::doubles() gave when the same device and driver were adopted with a queue.
struct HostDevice {
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physicalDevice = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t queueFamily = 0;
  VkQueue queue = VK_NULL_HANDLE;
  bool doubles = true;      ///< shaderFloat64 is enabled on `device`
  bool sampled = false;     ///< for mode sampled: shaderOutputLayer is enabled on `device`, if the device has it
  bool debugNames = false;  ///< VK_EXT_debug_utils is enabled on the instance
  /// VK_KHR_shader_subgroup_uniform_control_flow and its feature are enabled on `device`: optional, and then used.
  bool uniformControlFlow = false;
  /// Used to look up all Vulkan functions. Null: the system's loader.
  PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr;
  const VkAllocationCallbacks* allocator = nullptr;  ///< for the engine's objects, not the loader's
  VkPipelineCache pipelineCache = VK_NULL_HANDLE;    ///< for every pipeline; optional
  /// Gives all device memory. Without it, the engine allocates blocks of 1 to 16 MiB, of which its buffers take pieces,
  /// and what is larger by itself; it frees those that nothing uses, but for one block of each memory type.
  HostMemory memory{};
  /// Called around each vkQueueSubmit2, on the submitting thread. Set both if the host or another Device uses the queue
  /// on other threads, else none: Sweepers of one Device take turns.
  std::function<void()> lockQueue{}, unlockQueue{};
  OnCompiling onCompiling{};
};

/// What a VkDevice must have enabled: the version, and VK_TRUE for each feature needed. The host chains it into its
/// VkDeviceCreateInfo, without pEnabledFeatures, or copies the enabled features into its own structs.
struct Requirements {
  uint32_t apiVersion = VK_API_VERSION_1_3;  ///< of instance and device
  VkPhysicalDeviceFeatures2 core{};
  VkPhysicalDeviceVulkan12Features vulkan12{};
  VkPhysicalDeviceVulkan13Features vulkan13{};
  Requirements() {
    core.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
    vulkan12.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES;
    vulkan13.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES;
  }
  /// For VkDeviceCreateInfo::pNext: the host's chain `next`, with these features. Sets them in the host's own structs
  /// of these three types, and puts the ones that it lacks in front. The chain has no struct of single features that
  /// Vulkan 1.2 or 1.3 took over, such as VkPhysicalDeviceSynchronization2Features: Vulkan forbids these beside the
  /// struct of that version. Valid until this object moves or ends.
  const void* chain(void* next = nullptr);
};
/// What a host knows of its physical device before it makes a VkDevice: the arguments; `queueFamily`, the first with
/// graphics and compute, else the first with compute; and whether the device offers `doubles`, which let mode contact
/// leave less to the CPU, and mode `sampled`. `physicalDevice`: null for the best usable one, as DeviceOptions::index
/// says. Throws, with reasons, if it lacks what mode contact needs, or no device is usable.
RADAR_API HostDevice hostOf(VkInstance instance, VkPhysicalDevice physicalDevice = VK_NULL_HANDLE,
                            PFN_vkGetInstanceProcAddr getInstanceProcAddr = nullptr);
/// Of mode contact, and of `doubles` and `sampled` where those are true. Also reads `instance`, `physicalDevice` and
/// `getInstanceProcAddr`. Without shaderOutputLayer, mode sampled draws each sensor in a render pass of its own.
RADAR_API Requirements requirements(const HostDevice& host);

/// Why a host's physical device cannot be used for `mode`: one line per missing item, empty if it can. Reads only
/// `instance`, `physicalDevice` and `getInstanceProcAddr`.
RADAR_API std::vector<std::string> unsupportedReasons(const HostDevice& host, Mode mode);

struct DeviceOptions {
  uint32_t index = kNone;  ///< into listDevices(); kNone: the best usable one (discrete, integrated, virtual, CPU)
  /// Receives each warning or error of active validation layers, on any thread.
  std::function<void(const std::string&)> onValidation{};
  /// With onValidation: as HostDevice::debugNames, for messages and captures. Debian 12's layer (1.3.239) may erase the
  /// labels of a command buffer while another begins one, and crash.
  bool debugNames = true;
  bool doubles = true;  ///< false: do not use them, as if shaderFloat64 were missing
  OnCompiling onCompiling{};
};

/// A logical device with one queue: opened here and owned, or borrowed from a host. It, and all that uses it, ends
/// before main() does: when static objects are destroyed, the driver may be gone.
class RADAR_API Device {
 public:
  /// Throws, listing devices and reasons, if no device is usable, or the requested one is not.
  static Device open(const DeviceOptions& options = {});
  /// Throws with reasons if a handle is null, the queue family is none of the device's for compute, debugNames lacks
  /// its extension, the physical device lacks what mode contact needs, or its arithmetic breaks the error bounds. While
  /// this call or a Sweeper of this device runs, the host keeps other threads from using `queue`, unless it gives the
  /// lock functions. If `host` has a queue, submits at most twice, to check the arithmetic. Any number of Devices may
  /// be made from one VkDevice.
  static Device adopt(const HostDevice& host);
  ~Device();
  Device(Device&&) noexcept;
  Device& operator=(Device&&) noexcept;

  const std::string& name() const;
  const std::string& driver() const;
  /// Whether the device supports a mode: contact always; sampled needs graphics.
  bool supports(Mode mode) const;
  /// Whether the device solves pairs in double precision. It does if it has doubles and the checks at opening
  /// (checkArithmetic) found the operations involved to match the CPU's, bit for bit. Otherwise it solves pairs in
  /// float, with error bounds, and the CPU decides what that leaves open: the answers are the same. Without a queue:
  /// HostDevice::doubles, untested.
  bool doubles() const;
  const HostDevice& handles() const;
  /// By all that was made with this Device.
  MemoryUse memoryUse() const;

  struct Impl;
  Impl& impl() const { return *impl_; }

 private:
  explicit Device(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// Called before each of `all` steps, of which `done` are; `next` says what follows, and is empty after the last.
using OnProgress = std::function<void(uint32_t done, uint32_t all, const std::string& next)>;

/// Does now what the first Recorder or Sweeper of a device otherwise waits for: compiles every kernel that `mode` runs,
/// those of recordings included, and, if there is a queue, asks the known queries (checkAnswers). Throws as they do, or
/// if the device does not support the mode.
RADAR_API void prepare(const Device& device, Mode mode = Mode::contact, const OnProgress& onProgress = {});

/// A kernel as a device's compiler made it.
struct KernelReport {
  struct Statistic {
    std::string name, description;  ///< in the driver's words
    double value;
  };
  std::string name;                   ///< its shader, and what it is specialized for
  double milliseconds = 0;            ///< that the driver took
  std::vector<Statistic> statistics;  ///< empty without VK_KHR_pipeline_executable_properties
};

/// Compiles every kernel that the engine may run on a device, and runs none: the device may be one that only compiles.
/// `index`: as in DeviceOptions. Throws Error as Device::open() does.
RADAR_API std::vector<KernelReport> compileKernels(uint32_t index = kNone);

/// The check of one operation on which the bounds of mode contact rest, on numbers whose results the CPU knows: Vulkan
/// leaves drivers some freedom (its specification, "Precision and Operation of SPIR-V Instructions"). Device::open()
/// and Device::adopt() run the same checks and act on the results.
struct ArithmeticCheck {
  std::string operation;
  uint32_t tried = 0;   ///< results compared
  uint32_t wrong = 0;   ///< results that are not as needed
  double worst = 0;     ///< error of the worst result, in units in the last place; NaN: not measured
  std::string needed;   ///< what the engine relies on
  std::string ifWrong;  ///< what it does if a result is wrong
  bool passed() const { return wrong == 0; }
};

/// Runs all checks on `device`, those of doubles only if shaderFloat64 is enabled. Submits to the device's queue and
/// waits. Throws Error if there is no queue, or a submission fails.
RADAR_API std::vector<ArithmeticCheck> checkArithmetic(const Device& device);

/// Answers of one kind, compared with the CPU's.
struct AnswerCheck {
  std::string kind;
  uint32_t asked = 0;
  uint32_t wrong = 0;      ///< answers that differ in any bit; of mode sampled, brackets without the exact distance
  std::string stage;       ///< the first that differs: placing, drawing, searching, solving or describing
  std::string firstWrong;  ///< what was answered, and what was expected: each number, its bits and ulps
  bool passed() const { return wrong == 0; }
};

/// Asks queries of every kind, recorded ones and geometry in a host's buffers included, about a small scene that `seed`
/// decides. Submits to the device's queue and waits. Throws Error if there is no queue, or a submission fails.
///
/// Seeds 0 and 1 are how a device proves itself: the first Sweeper that searches on it, and the first Recorder, ask
/// them when they are made, but for clearances and mode sampled, and throw with the reasons if an answer is wrong. A
/// Recorder of a device without a queue cannot: then call this on a Device with a queue of the same driver, once.
RADAR_API std::vector<AnswerCheck> checkAnswers(const Device& device, uint64_t seed = 0);

}  // namespace radar
