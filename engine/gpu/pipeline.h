// Pipelines.
#pragma once

#include <span>

#include "gpu/device.h"
#include "gpu/handle.h"

namespace radar::gpu {

/// `constants`: values of specialization constants 0, 1, ..., if the shader has any. `fullSubgroups`: all subgroups
/// have Device::Impl::subgroupSize invocations; the local size is a multiple of it.
Pipeline computePipeline(const Device::Impl& device, VkPipelineLayout layout, std::span<const uint32_t> spirv,
                         const char* name, std::span<const uint32_t> constants = {}, bool fullSubgroups = false);

/// Depth only, no fragment shader, nothing culled; positions are float x3 at vertex binding 0, `stride` bytes apart;
/// viewport and scissor are dynamic; the depth test is less.
Pipeline depthPipeline(const Device::Impl& device, VkPipelineLayout layout, VkRenderPass renderPass,
                       std::span<const uint32_t> spirv, const char* name, uint32_t stride);

}  // namespace radar::gpu
