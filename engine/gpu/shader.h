// A shader as the build describes it (shaders/CMakeLists.txt): radar::shaders, in spirv/radar_shaders.h, are the
// engine's.
#pragma once

#include <cstdint>
#include <span>

#include <vulkan/vulkan_core.h>

namespace radar::gpu {

/// What a shader binds in descriptor set 0.
struct Binding {
  uint32_t number;
  /// STORAGE_BUFFER, UNIFORM_TEXEL_BUFFER or COMBINED_IMAGE_SAMPLER.
  VkDescriptorType type;
  const char* name;  ///< of the variable, or of its block
};

/// For which queries a shader runs, of mode contact or sampled only, or to check a device's arithmetic.
enum class Use { contact, sampled, arithmetic };

struct Shader {
  const char* name;  ///< its path in `shaders`, without suffixes
  Use use;
  VkShaderStageFlagBits stage;
  std::span<const uint32_t> spirv;
  /// For devices without doubles; empty if it needs no such variant. It binds no more, and has the same push constants.
  std::span<const uint32_t> spirvWithoutDoubles;
  std::span<const Binding> bindings;  ///< by number
  uint32_t pushBytes;                 ///< of push constants; 0: none
};

/// Whether a module computes with doubles: it declares the capability Float64.
inline bool hasDoubles(std::span<const uint32_t> spirv) {
  constexpr uint32_t kHeader = 5, kCapability = 17, kFloat64 = 10;
  for (size_t at = kHeader; at < spirv.size(); at += spirv[at] >> 16) {
    if ((spirv[at] & 0xffff) == kCapability && spirv[at + 1] == kFloat64) return true;
  }
  return false;
}

}  // namespace radar::gpu
