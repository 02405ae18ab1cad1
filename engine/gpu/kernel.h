// Shaders with checked arguments: a wrong or missing buffer, or a push struct of the wrong size, is an error. Layouts
// and sizes are read from the shader's SPIR-V.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "gpu/array.h"
#include "gpu/handle.h"
#include "gpu/spirv.h"
#include "shaders/shared/slot.h"

namespace radar::gpu {

/// Number of workgroups, of `perGroup` items each, that cover `items`.
constexpr uint32_t groupsFor(uint64_t items, uint32_t perGroup) {
  return static_cast<uint32_t>((items + perGroup - 1) / perGroup);
}

enum class Subgroups {
  any,  ///< of any size
  full  ///< all of Device::Impl::subgroupSize invocations: a workgroup of that size is one subgroup
};

/// Where a depth-only pipeline draws, and how far apart its vertices are, bytes.
struct DepthTarget {
  VkRenderPass renderPass;
  uint32_t vertexStride;
};

/// A pipeline, of a compute shader or for depth-only draws, and its layouts. Immutable, so any number of users on any
/// thread may share it.
class Kernel {
 public:
  /// `constants`: values of specialization constants 0, 1, ... Throws Error if reflectShader (gpu/spirv.h)
  /// does, or if the shader has no descriptors or more than kMaxPushBytes of push constants.
  Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name,
         std::span<const uint32_t> constants = {}, Subgroups subgroups = Subgroups::any);
  /// A depth-only pipeline of a vertex shader (gpu/pipeline.h), for bindForDraws. Throws Error as above.
  Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name, const DepthTarget& target);
  Kernel(const Kernel&) = delete;
  Kernel& operator=(const Kernel&) = delete;

  /// Supported by every device.
  static constexpr uint32_t kMaxPushBytes = 128;

 private:
  friend class KernelArguments;
  Kernel(const Device::Impl& device, std::span<const uint32_t> spirv, const char* name, VkShaderStageFlagBits stage);
  std::string describe(const Descriptor& descriptor) const;

  const Device::Impl* device_;
  std::string name_;
  VkShaderStageFlagBits stage_;
  ShaderInterface interface_;
  DescriptorSetLayout setLayout_;
  PipelineLayout layout_;
  Pipeline pipeline_;
};

/// A slot and the resource bound to it. A buffer of another element type does not compile.
class Argument {
 public:
  /// Binds a storage buffer.
  template <class T>
  Argument(Slot<T> slot, const Array<T>& array)
      : binding_(slot.number), elementBytes_(sizeof(T)), buffer_(&array.buffer()) {}
  /// Binds a uniform texel buffer or a storage buffer, whichever the shader declares.
  template <class T>
  Argument(Slot<T> slot, const TexelArray<T>& array)
      : binding_(slot.number), elementBytes_(sizeof(T)), buffer_(&array.buffer()), texels_(array.view()) {}
  /// Binds an image in SHADER_READ_ONLY_OPTIMAL layout, with its sampler.
  Argument(Slot<SampledImage> slot, VkImageView image, VkSampler sampler)
      : binding_(slot.number), image_(image), sampler_(sampler) {}

 private:
  friend class KernelArguments;
  uint32_t binding_;
  size_t elementBytes_ = 0;
  const Buffer* buffer_ = nullptr;
  VkBufferView texels_ = VK_NULL_HANDLE;
  VkImageView image_ = VK_NULL_HANDLE;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

/// One user's descriptor set for a kernel, and the dispatches or draws with it. The kernel outlives it.
class KernelArguments {
 public:
  explicit KernelArguments(const Kernel& kernel);

  /// Sets every binding of the shader, each once, in any order. Cheap if no buffer has changed since the last call.
  /// Otherwise, and always with an image, no dispatch with these arguments may be pending. Call it again after a buffer
  /// has grown. Binds a storage buffer up to the device's maxStorageBufferRange. Throws Error, naming kernel and
  /// binding, and changes nothing, if a binding is missing, unknown, given twice or of another descriptor type, or if
  /// sizeof(T) differs from the stride of the shader's runtime array, or from the size of its struct if it has none.
  void set(std::initializer_list<Argument> arguments);

  /// Binds the pipeline and the set, pushes constants and dispatches; the caller records the barriers. Records nothing
  /// if `groups` is 0. More than 65535 workgroups are laid out in rows, and a few more than `groups` may run: shaders
  /// compare workgroupIndex() (shared/workgroup.glsl) with their number of items. Throws Error if `set` has not been
  /// called, or if sizeof(Push) differs from the size of the shader's push constants.
  void dispatch(const Commands& commands, uint32_t groups) const { record(commands, groups, {}); }
  template <class Push>
  void dispatch(const Commands& commands, uint32_t groups, const Push& push) const {
    record(commands, groups, bytesOfPush(push));
  }
  /// The same with the VkDispatchIndirectCommand at byte `offset` of `buffer`, which has the usage INDIRECT_BUFFER.
  void dispatchIndirect(const Commands& commands, const Buffer& buffer, VkDeviceSize offset) const {
    recordIndirect(commands, buffer, offset, {});
  }
  template <class Push>
  void dispatchIndirect(const Commands& commands, const Buffer& buffer, VkDeviceSize offset, const Push& push) const {
    recordIndirect(commands, buffer, offset, bytesOfPush(push));
  }

  /// Binds the pipeline and the set of a depth-only kernel for the draws that follow. Throws Error if `set` has not
  /// been called.
  void bindForDraws(const Commands& commands) const;

 private:
  using PushBytes = std::span<const std::byte>;
  template <class Push>
  static PushBytes bytesOfPush(const Push& push) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= Kernel::kMaxPushBytes);
    return std::as_bytes(std::span(&push, 1));
  }
  void check(const Descriptor& descriptor, const Argument& argument) const;
  void write(const Descriptor& descriptor, const Argument& argument) const;
  void checkDispatch(PushBytes push) const;
  void bind(const Commands& commands, PushBytes push) const;
  void record(const Commands& commands, uint32_t groups, PushBytes push) const;
  void recordIndirect(const Commands& commands, const Buffer& buffer, VkDeviceSize offset, PushBytes push) const;

  const Kernel* kernel_;
  DescriptorPool pool_;
  VkDescriptorSet set_ = VK_NULL_HANDLE;
  std::vector<uint64_t> bound_;  // Buffer::identity() of each descriptor; 0: an image, or nothing yet
  bool complete_ = false;
};

}  // namespace radar::gpu
