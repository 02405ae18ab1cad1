// Shaders and what they bind: a dispatch is one statement, which names both. A wrong or missing argument, or a push
// struct of the wrong size, is an error.
#pragma once

#include <array>
#include <compare>
#include <initializer_list>
#include <span>
#include <type_traits>
#include <vector>

#include "gpu/buffer.h"
#include "gpu/depth_array.h"
#include "gpu/device.h"
#include "gpu/shader.h"
#include "shaders/shared/slot.h"

namespace radar::gpu {

/// Number of workgroups, of `perGroup` items each, that cover `items`.
constexpr uint32_t groupsFor(uint64_t items, uint32_t perGroup) {
  return static_cast<uint32_t>((items + perGroup - 1) / perGroup);
}

/// Of push constants: supported by every device.
inline constexpr uint32_t kMostPushBytes = 128;

enum class Subgroups {
  any,  ///< of any size
  full  ///< all of Device::Impl::subgroupSize invocations: a workgroup of that size is one subgroup
};

/// A shader, the values of its specialization constants 0, 1, ... (0 unless given), and its subgroups.
struct Program {
  /// Those of the shaders; the next is for shaders/shared/divide.glsl.
  static constexpr size_t kMostConstants = 9;

  constexpr Program(const Shader& its, const std::array<uint32_t, kMostConstants>& values = {},
                    Subgroups kind = Subgroups::any)
      : shader(&its), constants(values), subgroups(kind) {}
  auto operator<=>(const Program&) const = default;

  const Shader* shader;
  std::array<uint32_t, kMostConstants> constants;
  Subgroups subgroups;
};

/// A program's pipeline and layouts on one device, made at its first use by any thread, and shared.
struct Kernel;

/// A slot and the resource bound to it. A buffer of another element type does not compile.
class Argument {
 public:
  /// Binds a storage buffer, up to the device's maxStorageBufferRange, or its texels, whichever the shader declares.
  template <class T>
  Argument(Slot<T> slot, const Array<T>& array) : binding_(slot.number), buffer_(&array.buffer()) {}
  /// Binds an image in SHADER_READ_ONLY_OPTIMAL layout, with its sampler.
  Argument(Slot<SampledImage> slot, const DepthArray& image, VkSampler sampler)
      : binding_(slot.number), image_(&image), sampler_(sampler) {}

 private:
  friend class Passes;
  uint64_t identity() const { return buffer_ != nullptr ? buffer_->identity() : image_->identity(); }

  uint32_t binding_;
  const Buffer* buffer_ = nullptr;
  const DepthArray* image_ = nullptr;
  VkSampler sampler_ = VK_NULL_HANDLE;
};

/// How many workgroups run: more than 65535 are laid out in rows, and a few more than `count` may run: shaders compare
/// workgroupIndex() (shaders/shared/workgroup.glsl) with their number of items. Or the VkDispatchIndirectCommand at
/// byte `offset` of a buffer that has the usage INDIRECT_BUFFER.
struct Groups {
  Groups(uint32_t number) : count(number) {}
  Groups(const Buffer& buffer, VkDeviceSize byte) : commands(&buffer), offset(byte) {}
  uint32_t count = 0;
  const Buffer* commands = nullptr;
  VkDeviceSize offset = 0;
};

/// Records dispatches, for one user. Descriptor sets are kept, and found again by program and buffers.
class Passes {
 public:
  /// Makes now the pipelines of `programs`, and a set for each time that one is listed: as long as no recording needs
  /// more, dispatches create nothing.
  explicit Passes(const Device::Impl& device, std::initializer_list<Program> programs = {});
  /// The same later.
  void reserve(std::initializer_list<Program> programs);

  /// Begins a recording: none of the earlier ones is pending or will be, so that their sets may be given other buffers.
  void begin() { ++recording_; }

  /// Binds the program and its arguments, pushes constants and dispatches, unless there are no workgroups; the caller
  /// records the barriers. `arguments`: every binding of the shader, each once, in any order. Throws Error, naming
  /// shader and binding, if one is missing, unknown, given twice or of another descriptor type, or if sizeof(Push)
  /// differs from the size of the shader's push constants.
  template <class Push>
  void operator()(const Commands& commands, const Program& program, const Groups& groups, const Push& push,
                  std::initializer_list<Argument> arguments) {
    static_assert(std::is_trivially_copyable_v<Push> && sizeof(Push) <= kMostPushBytes);
    dispatch(commands, program, groups, std::as_bytes(std::span(&push, 1)), arguments);
  }
  void operator()(const Commands& commands, const Program& program, const Groups& groups,
                  std::initializer_list<Argument> arguments) {
    dispatch(commands, program, groups, {}, arguments);
  }
  /// Binds a vertex shader's program and its arguments for the depth-only draws that follow: of gpu::Vertex at vertex
  /// binding 0, in a depthRenderPass(), nothing culled; the depth test is less. Viewport and scissor are dynamic.
  void bindForDraws(const Commands& commands, const Program& program, std::initializer_list<Argument> arguments);

 private:
  static constexpr size_t kMostBindings = 34;
  struct Set {
    Program program;
    const Kernel* kernel;
    DescriptorPool pool;
    VkDescriptorSet handle = VK_NULL_HANDLE;
    std::array<uint64_t, kMostBindings> bound{};  ///< identities, in the order of the shader's bindings; 0: nothing
    uint64_t recording = 0;                       ///< the last that uses it
  };
  using Bytes = std::span<const std::byte>;
  Set& add(const Program& program);
  const Set& setFor(const Program& program, std::initializer_list<Argument> arguments);
  void write(Set& set, const Binding& binding, const Argument& argument) const;
  void dispatch(const Commands& commands, const Program& program, const Groups& groups, Bytes push,
                std::initializer_list<Argument> arguments);

  const Device::Impl* device_;
  std::vector<Set> sets_;
  uint64_t recording_ = 1;
};

/// Makes the program's pipeline, unless that has been done.
void compile(const Device::Impl& device, const Program& program);

/// Makes the program's pipeline anew.
KernelReport reportOf(const Device::Impl& device, const Program& program);

/// Makes a pipeline: drivers compile it now, and some take their time. `constants`: values of specialization constants
/// 0, 1, ..., if the shader has any.
Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants = {},
                         Subgroups subgroups = Subgroups::any);
/// Of a vertex shader, for depth-only draws of gpu::Vertex in a depthRenderPass().
Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                       const char* name);

}  // namespace radar::gpu
