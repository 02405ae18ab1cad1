// Makes pipelines: drivers compile them now, and some take their time.
#pragma once

#include <span>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace radar::gpu {

enum class Subgroups {
  any,  ///< of any size
  full  ///< all of Device::Impl::subgroupSize invocations: a workgroup of that size is one subgroup
};

/// `constants`: values of specialization constants 0, 1, ..., if the shader has any.
Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants = {},
                         Subgroups subgroups = Subgroups::any);

/// Of a vertex shader, for depth-only draws of gpu::Vertex in a depthRenderPass().
Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                       const char* name);

}  // namespace radar::gpu
