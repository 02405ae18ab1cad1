// The descriptors and push constants that a shader declares, read from its SPIR-V.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "gpu/api.h"

namespace radar::gpu {

/// One binding of descriptor set 0.
struct Descriptor {
  uint32_t binding = 0;
  std::string name;  ///< of the variable, or of its block if it has none; empty in a stripped module
  /// STORAGE_BUFFER, UNIFORM_TEXEL_BUFFER (textureBuffer, samplerBuffer) or COMBINED_IMAGE_SAMPLER.
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  /// Of a storage buffer whose last member is a runtime array: the array's stride and its offset, bytes; else 0.
  uint32_t stride = 0;
  uint32_t arrayOffset = 0;
  /// Of any other storage buffer: the size of its struct, as C++ sizeof; else 0.
  uint32_t bytes = 0;
};

struct ShaderInterface {
  std::vector<Descriptor> descriptors;  ///< in the order of their bindings, each binding once
  uint32_t pushBytes = 0;               ///< size of the push constants, as C++ sizeof; 0: none
};

/// Expects one shader of the stage (compute or vertex), "main", with descriptors of the types above in set 0, each with
/// its own binding. Throws Error naming anything else. `name`: of the shader, for messages.
ShaderInterface reflectShader(std::span<const uint32_t> spirv, const char* name,
                              VkShaderStageFlagBits stage = VK_SHADER_STAGE_COMPUTE_BIT);

}  // namespace radar::gpu
